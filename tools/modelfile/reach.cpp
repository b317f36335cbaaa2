// SPDX-License-Identifier: Apache-2.0
#include "tools/modelfile/reach.h"

#include <Eigen/Geometry>
#include <array>
#include <cstddef>

#include "core/base/types.h"

namespace palpate::modelfile {

double reachingPart(const Positions& positions, std::span<const double> radius, double travel) {
  const auto at = [](std::int32_t i) { return static_cast<std::size_t>(i); };
  double all = 0.0, reaching = 0.0;
  for (std::size_t t = 0; t < positions.contact_triangles.size(); t += 3) {
    const auto node = positions.contact_triangles.subspan(t, 3);
    std::array<Vec3, 3> X;
    for (std::size_t k = 0; k < 3; ++k)
      X[k] = Eigen::Map<const Vec3>(positions.surface_positions.data() + 3 * at(node[k]));
    const double area = (X[1] - X[0]).cross(X[2] - X[0]).norm();
    for (const std::int32_t i : node) {
      const std::int32_t position = positions.position_of_node[at(i)];
      if (position < 0 || positions.accessible[at(position)] == 0) continue;
      all += area;
      if (radius[at(position)] >= travel) reaching += area;
    }
  }
  return all > 0.0 ? reaching / all : 0.0;
}

std::array<Reach, 3> reachOf(const Positions& positions, std::span<const double> domain,
                             std::span<const double> series) {
  const auto at = [&](double travel) {
    return Reach{travel, reachingPart(positions, domain, travel), reachingPart(positions, series, travel)};
  };
  return {at(0.007), at(0.010), at(0.015)};
}

}  // namespace palpate::modelfile
