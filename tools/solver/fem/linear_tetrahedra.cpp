// SPDX-License-Identifier: Apache-2.0
#include "tools/solver/fem/linear_tetrahedra.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <stdexcept>
#include <string>

namespace palpate::solver {

std::vector<IntegrationPoint<4>> linearTetrahedra(std::span<const Vec3> nodes,
                                                  std::span<const std::array<std::int32_t, 4>> tetrahedra,
                                                  const Material& material) {
  std::vector<IntegrationPoint<4>> points(tetrahedra.size());
  for (std::size_t e = 0; e < tetrahedra.size(); ++e) {
    const auto& t = tetrahedra[e];
    for (const std::int32_t node : t)
      if (node < 0 || node >= static_cast<std::int32_t>(nodes.size()))
        throw std::invalid_argument("tetrahedron " + std::to_string(e) + ": node " + std::to_string(node) +
                                    " of " + std::to_string(nodes.size()));
    const auto corner = [&](std::size_t a) { return nodes[static_cast<std::size_t>(t[a])]; };
    Mat3 edges;
    for (std::size_t a = 0; a < 3; ++a) edges.col(static_cast<Eigen::Index>(a)) = corner(a + 1) - corner(0);
    const double volume = edges.determinant() / 6.0;
    if (!(volume > 0.0))
      throw std::invalid_argument("tetrahedron " + std::to_string(e) + ": volume " + std::to_string(volume));
    const Mat3 inverse = edges.inverse();
    IntegrationPoint<4>& point = points[e];
    point.nodes = t;
    point.gradients.bottomRows<3>() = inverse;
    point.gradients.row(0) = -inverse.colwise().sum();
    point.weight = volume;
    point.lame = material.of(e).lame();
    point.law = material.lawIn(e);
  }
  return points;
}

}  // namespace palpate::solver
