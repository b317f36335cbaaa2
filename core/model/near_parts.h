// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/base/contact_point.h"
#include "core/base/index.h"
#include "core/base/types.h"
#include "core/model/meta_model.h"

namespace palpate {

/// The contact positions that answer for the field of a touch at s, and their weights: mixed as the force is, by the cubic over
/// the triangle; of a load-driven model as its contact's displacement is, linearly. Real-time: yes.
[[nodiscard]] inline Stencil fieldStencil(const MetaModel& model,
                                          const ContactPoint& s) noexcept PALPATE_NONBLOCKING {
  return model.isDisplacementDriven() ? model.mixing().at(model.surface(), s)
                                      : linearStencil(model.surface().mix(s));
}

/// One of the near fields that make up that of a touch.
struct NearPart {
  const NearField& field;
  std::int32_t source;  ///< of the field: a contact position, or an edge
  std::size_t rows;     ///< how many of the functions it has, the first
  double weight;
  Vec3 centre;   ///< of the source, m
  double reach;  ///< from there, at most, m
};

/// Calls add(NearPart) for the near fields that make up the one of a touch at s: of the stencil's positions, and of the edges
/// round s with the weights 4 lambda_a lambda_b. The same ones in the same order wherever s is in its triangle.
///                                                                                            docs/design.md, Parts
/// Real-time: as add is.
template <class Add>
void forEachNear(const MetaModel& model, const ContactPoint& s, const Stencil& stencil,
                 const Add& add) noexcept PALPATE_NONBLOCKING {
  const ModelView& view = model.view();
  const std::size_t rows = modeCoefficients(model.attributes(), index(model.functions().size()));
  for (std::size_t b = 0; b < stencil.count; ++b) {
    const std::int32_t position = stencil.position[b], node = view.contact_node[index(position)];
    add(NearPart{model.nearField(), position, rows, stencil.weight[b],
                 Eigen::Map<const Vec3>(view.surface_positions.data() + 3 * index(node)),
                 model.reachOfNearFields()});
  }
  if (model.edgeCoefficients() == 0 || stencil.count == 0) return;
  const std::array<std::int32_t, 6>& place = model.places().of(s.triangle);
  const auto positions = static_cast<std::int32_t>(view.positions());
  const std::array<Vec3, 3> X = model.surface().corners(s.triangle);
  for (std::size_t k = 0; k < 3 && place[0] >= 0; ++k) {
    const double weight = 4.0 * s.barycentric[(k + 1) % 3] * s.barycentric[(k + 2) % 3];
    add(NearPart{model.edgeField(), place[3 + k] - positions, model.edgeCoefficients(), weight,
                 0.5 * (X[(k + 1) % 3] + X[(k + 2) % 3]), model.reachOfEdges()});
  }
}

}  // namespace palpate
