// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <numbers>
#include <vector>

#include "tools/mesh/box_mesh.h"
#include "tools/solver/fem/integration_point.h"

namespace palpate::solver {

/// A part of a load of 1 N along +z on the surface z = 0 of the half-space z >= 0.
struct PointLoad {
  Vec3 at;
  double share;
};

/// Displacement of the half-space by a point load of 1 N along +z in the origin, m. Boussinesq's solution: K. L. Johnson,
/// Contact Mechanics, Cambridge University Press 1985, Section 3.2.
inline Vec3 boussinesq(const Vec3& X, const Elasticity& elasticity) {
  const double G = elasticity.lame().mu, nu = elasticity.nu, rho = X.norm();
  const double across = X.z() / std::pow(rho, 3) - (1.0 - 2.0 * nu) / (rho * (rho + X.z()));
  const double along = std::pow(X.z(), 2) / std::pow(rho, 3) + 2.0 * (1.0 - nu) / rho;
  return Vec3(across * X.x(), across * X.y(), along) / (4.0 * std::numbers::pi * G);
}

/// Cells between the given coordinates, six tetrahedra each. Node (i, j, k) has the index i + nx (j + ny k).
inline mesh::TetMesh blockOf(const std::vector<double>& x, const std::vector<double>& y,
                             const std::vector<double>& z) {
  const auto count = [](const std::vector<double>& list) { return static_cast<int>(list.size()); };
  mesh::TetMesh block = mesh::makeBox(Vec3::Ones(), {count(x), count(y), count(z)});
  auto node = block.nodes.begin();
  for (const double at_z : z)
    for (const double at_y : y)
      for (const double at_x : x) *node++ = Vec3(at_x, at_y, at_z);
  return block;
}

/// 0 and on, in steps that begin with `first` and grow by the factor `growth` beyond `even`, up to `end`.
inline std::vector<double> growingSteps(double first, double even, double growth, double end) {
  std::vector<double> list{0.0};
  for (double step = first; list.back() + 1.5 * step < end;) {
    list.push_back(list.back() + step);
    if (list.back() >= even) step *= growth;
  }
  list.push_back(end);
  return list;
}

/// Displacement of given nodes of the half-space, the cut of a body out of it, by a load of 1 N; 0 at all others. 3 N, m. A body
/// that follows it there is as large as the half-space.
inline Eigen::VectorXd halfSpaceAt(const std::vector<std::int32_t>& cut, const std::vector<Vec3>& nodes,
                                   const std::vector<PointLoad>& loads, const Elasticity& elasticity) {
  Eigen::VectorXd u = Eigen::VectorXd::Zero(3 * static_cast<Eigen::Index>(nodes.size()));
  for (const std::int32_t node : cut)
    for (const PointLoad& load : loads)
      u.segment<3>(3 * node) +=
          load.share * boussinesq(nodes[static_cast<std::size_t>(node)] - load.at, elasticity);
  return u;
}

}  // namespace palpate::solver
