// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/contact_point.h"
#include "core/base/index.h"
#include "core/base/max_tools.h"
#include "core/base/types.h"
#include "core/model/meta_model.h"
#include "core/model/touch_patch.h"

namespace palpate {

/// Fields of a "displacement" model end at this many r_max.
inline constexpr double kShownRadii = 2.0;

/// The functions that fields are sums of. Beyond abs(d) = limit those of a "displacement" model are extrapolated linearly along
/// d, up to kShownRadii limits; then they stay, as those of a load-driven model do at the limit. docs/design.md, Series
/// @param limit  m, N or 1  @param[out] values  functions().size(). @return the parameter as far as fields go. Real-time: yes.
Vec3 fieldFunctions(const MetaModel& model, const Vec3& parameter, double limit,
                    std::span<double> values) noexcept PALPATE_NONBLOCKING;

/// Their gradients by d, 1/m, of a "displacement" model; beyond kShownRadii limits, where a tool's own part goes on in proportion
/// (ownPart()), those of that. @param[out] gradient  functions().size(). Real-time: yes.
void fieldGradients(const MetaModel& model, const Vec3& d, double limit,
                    std::span<Vec3> gradient) noexcept PALPATE_NONBLOCKING;

/// Scratch of the field evaluation; one per thread, allocated before the loop.
struct FieldScratch {
  explicit FieldScratch(const MetaModel& model);
  std::vector<float> amplitudes;        ///< [n] y, m
  std::vector<float> near_block;        ///< the largest of the near fields
  PatchNodes patch;                     ///< of the tool that is being evaluated
  PatchSources loads;                   ///< of its patch
  std::vector<Eigen::Vector4f> weight;  ///< [Ns] of a patch's nodes; zero between uses
  /// Patches of tools, as they were used last: a tool that sticks finds its own again.
  std::array<TouchPatch, kMaxTools + 1> touches;
  std::array<std::uint64_t, kMaxTools + 1> asked{};  ///< the how many-th question each answered last
  std::uint64_t questions{0};

  /// The patch at s, in the place of the one that was not asked for the longest: the reference holds while fewer than
  /// kMaxTools + 1 others are asked for. Real-time: yes.
  const TouchPatch& touchAt(const MetaModel& model, const ContactPoint& s) noexcept PALPATE_NONBLOCKING;
};

/// One tool's part in a field.
struct FieldSource {
  ContactPoint s;
  Vec3 parameter = Vec3::Zero();  ///< Response::parameter
  double gain{1.0};               ///< any finite number

  [[nodiscard]] bool operator==(const FieldSource& other) const noexcept {
    return s == other.s && parameter == other.parameter && gain == other.gain;
  }
};

/// The contact positions that answer for the field of a touch at s, and their weights: mixed as the force is, by the cubic over
/// the triangle; of a load-driven model as its contact's displacement is, linearly. Real-time: yes.
[[nodiscard]] Stencil fieldStencil(const MetaModel& model,
                                   const ContactPoint& s) noexcept PALPATE_NONBLOCKING;

/// One of the near fields that make up that of a touch.
struct NearPart {
  const NearField& field;
  std::int32_t source;          ///< of the field: a contact position, or an edge
  std::span<const double> phi;  ///< its functions
  double weight;
  Vec3 centre;   ///< of the source, m
  double reach;  ///< from there, at most, m
};

/// Calls add(NearPart) for the near fields that make up the one of a touch at s: of the stencil's positions, and of the edges
/// round s with the weights 4 lambda_a lambda_b.                                              docs/design.md, Parts
/// @param phi  [Cm] functions of near fields. Real-time: as add is.
template <class Add>
void forEachNear(const MetaModel& model, const ContactPoint& s, const Stencil& stencil,
                 std::span<const double> phi, const Add& add) noexcept PALPATE_NONBLOCKING {
  const ModelView& view = model.view();
  for (std::size_t b = 0; b < stencil.count; ++b) {
    const std::int32_t position = stencil.position[b], node = view.contact_node[index(position)];
    add(NearPart{model.nearField(), position, phi, stencil.weight[b],
                 Eigen::Map<const Vec3>(view.surface_positions.data() + 3 * index(node)),
                 model.reachOfNearFields()});
  }
  if (model.edgeCoefficients() == 0 || stencil.count == 0) return;
  const std::array<std::int32_t, 6>& place = model.places().of(s.triangle);
  const auto positions = static_cast<std::int32_t>(view.positions());
  const std::array<Vec3, 3> X = model.surface().corners(s.triangle);
  for (std::size_t k = 0; k < 3 && place[0] >= 0; ++k) {
    const double weight = 4.0 * s.barycentric[(k + 1) % 3] * s.barycentric[(k + 2) % 3];
    if (weight > 0.0)
      add(NearPart{model.edgeField(), place[3 + k] - positions, phi.first(model.edgeCoefficients()), weight,
                   0.5 * (X[(k + 1) % 3] + X[(k + 2) % 3]), model.reachOfEdges()});
  }
}

/// Displacement of the surface nodes, far plus near field, superposed over the tools (docs/design.md, Parts).
/// @param[out] u  [Ns][3], m, overwritten; zero when no source is accessible. Cost O(n Ns). Real-time: yes.
void evaluateField(const MetaModel& model, std::span<const FieldSource> sources, FieldScratch& scratch,
                   std::span<float> u) noexcept PALPATE_NONBLOCKING;

/// The field where tools are, m. A tool's own part comes from a table (ContactDimple). @param points  triangle -1: zero there  @param[out] u  [points]
/// Cost O(points C), and with others beside O(points sources (C n + K)). Real-time: yes.
void fieldAt(const MetaModel& model, std::span<const FieldSource> sources, FieldScratch& scratch,
             std::span<const ContactPoint> points, std::span<Vec3> u) noexcept PALPATE_NONBLOCKING;

/// What one patch does to another at rest: displacement of `to` by unit forces on `from`, column by force, and its
/// derivatives by the barycentric weights of `to`, m/N. Of a "displacement" model. Cost O(k K + n). Real-time: yes.
[[nodiscard]] std::array<Mat3, 4> complianceBetween(const MetaModel& model, const TouchPatch& from,
                                                    const TouchPatch& to,
                                                    FieldScratch& scratch) noexcept PALPATE_NONBLOCKING;

}  // namespace palpate
