// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "core/surface/surface_mesh.h"

namespace palpate::testing {

/// A field given at the nodes, at s. @param field  [Ns][3]
[[nodiscard]] inline Vec3 interpolated(const SurfaceMesh& surface, std::span<const float> field,
                                       const ContactPoint& s) {
  const NodeMix nodes = surface.nodesAt(s);
  Vec3 sum = Vec3::Zero();
  for (std::size_t k = 0; k < 3; ++k)
    sum += nodes.weight[k] *
           Eigen::Map<const Eigen::Vector3f>(field.data() + 3 * static_cast<std::size_t>(nodes.node[k]))
               .cast<double>();
  return sum;
}

}  // namespace palpate::testing
