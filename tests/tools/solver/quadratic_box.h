// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <map>
#include <utility>
#include <vector>

#include "boxes.h"
#include "tools/solver/fem/linear_tetrahedra.h"

namespace palpate::solver {

/// A box of straight-edged tetrahedra of 10 nodes, 4 Gauss points each, stiffer in every other element.
struct QuadraticBox {
  std::vector<Vec3> nodes;  ///< corners first
  std::vector<IntegrationPoint<10>> points;

  explicit QuadraticBox(const Box& box) : nodes(box.nodes()) {
    constexpr double kFar = 0.5854101966249685, kNear = 0.1381966011250105;
    const auto tetrahedra = box.tetrahedra();
    Material material{{160e3, 0.45}};
    for (std::size_t e = 0; e < tetrahedra.size(); ++e)
      material.by_element.push_back(e % 2 == 0 ? Elasticity{160e3, 0.45} : Elasticity{480e3, 0.3});
    for (const IntegrationPoint<4>& linear : linearTetrahedra(nodes, tetrahedra, material)) {
      const std::array<std::int32_t, 10> all = withMidSides(linear.nodes);
      for (Eigen::Index gauss = 0; gauss < 4; ++gauss) {
        Eigen::Vector4d L = Eigen::Vector4d::Constant(kNear);
        L[gauss] = kFar;
        points.push_back({all, gradients(L, linear.gradients), 0.25 * linear.weight, linear.lame});
      }
    }
  }

  [[nodiscard]] Eigen::Index size() const { return 3 * static_cast<Eigen::Index>(nodes.size()); }

 private:
  static constexpr int kEdges[6][2] = {{0, 1}, {1, 2}, {0, 2}, {0, 3}, {1, 3}, {2, 3}};

  std::array<std::int32_t, 10> withMidSides(const std::array<std::int32_t, 4>& corners) {
    std::array<std::int32_t, 10> all{};
    std::copy(corners.begin(), corners.end(), all.begin());
    for (std::size_t k = 0; k < 6; ++k) {
      const auto a = corners[static_cast<std::size_t>(kEdges[k][0])];
      const auto b = corners[static_cast<std::size_t>(kEdges[k][1])];
      const auto [at, is_new] =
          middles_.try_emplace(std::minmax(a, b), static_cast<std::int32_t>(nodes.size()));
      const Vec3 middle = 0.5 * (nodes[static_cast<std::size_t>(a)] + nodes[static_cast<std::size_t>(b)]);
      if (is_new) nodes.push_back(middle);
      all[4 + k] = at->second;
    }
    return all;
  }

  /// N_a = L_a (2 L_a - 1) at corners, 4 L_a L_b between them.
  static Eigen::Matrix<double, 10, 3> gradients(const Eigen::Vector4d& L,
                                                const Eigen::Matrix<double, 4, 3>& g) {
    Eigen::Matrix<double, 10, 3> all;
    for (Eigen::Index a = 0; a < 4; ++a) all.row(a) = (4.0 * L[a] - 1.0) * g.row(a);
    for (Eigen::Index k = 0; k < 6; ++k) {
      const int a = kEdges[k][0], b = kEdges[k][1];
      all.row(4 + k) = 4.0 * (L[a] * g.row(b) + L[b] * g.row(a));
    }
    return all;
  }

  std::map<std::pair<std::int32_t, std::int32_t>, std::int32_t> middles_;
};

}  // namespace palpate::solver
