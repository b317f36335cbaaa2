// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "core/base/multi_index.h"
#include "round_organ.h"
#include "tools/modelfile/write_model.h"

namespace palpate::testing {

inline constexpr double kPlateStiffness = 300.0;  // N/m, in each direction

/// A round plate, 0.1 m wide, accessible from both sides: the synthetic organ's nodes laid flat, f = k d.
/// It goes along as a whole under a tool, which other tools notice. @param half  of the thickness, m
inline MetaModel thinPlate(double half) {
  constexpr double kRim = 0.3;  // |z| / radius of the ball's nodes below which they are the plate's rim
  SyntheticOptions options;
  options.fixed_below = options.helper_below = -2.0;
  modelfile::ModelData data = syntheticModel(options);
  for (std::size_t i = 2; i < data.surface_positions.size(); i += 3)
    data.surface_positions[i] =
        half * std::clamp(data.surface_positions[i] / (kRim * options.radius), -1.0, 1.0);
  std::copy(data.surface_positions.begin(), data.surface_positions.end(), data.mesh_nodes.begin());
  const MonomialBasis basis(options.order);
  const auto size = static_cast<std::size_t>(basis.size());
  for (std::size_t i = 0; i < data.contact_force.size(); ++i) {
    const MultiIndex alpha = basis[static_cast<int>(i / 3 % size)];
    const bool linear = alpha[0] + alpha[1] + alpha[2] == 1 && alpha[i % 3] == 1;
    data.contact_force[i] = linear ? kPlateStiffness * options.reference_displacement : 0.0;
  }
  fillStiffness(data, [](const Vec3&) -> Mat3 { return kPlateStiffness * Mat3::Identity(); });
  goesAlong(data);
  const TemporaryFile file("plate.h5");
  modelfile::writeModel(file.path(), data);
  return MetaModel::load(file.path());
}

}  // namespace palpate::testing
