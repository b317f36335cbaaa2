// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "tools/solver/fem/integration_point.h"

namespace palpate::solver {

/// Elements of ten nodes and straight edges: displacement is quadratic, so its gradient is linear within an element.
///   N_a = L_a (2 L_a - 1) at corners, 4 L_a L_b in the middle of edge a-b, L the barycentric coordinates
/// With straight edges the gradients of L are those of the linear element.             docs/design.md, Elements
struct QuadraticTetrahedra {
  using Midsides = std::array<std::int32_t, 6>;  ///< nodes in the middle of mesh::kTetEdges

  /// Four Gauss points for each element, of degree 2: K0 is exact. CalculiX' C3D10 has the same.
  std::vector<IntegrationPoint<10>> points;
  /// Where det F is looked at, since it is cubic within an element: the Gauss points and the ten nodes, of weight 0.
  std::vector<IntegrationPoint<10>> det_points;

  /// @param linear  the elements' linear ones, one point each
  /// @throw std::invalid_argument naming the element with a node out of range or away from the middle of its edge
  QuadraticTetrahedra(std::span<const Vec3> nodes, std::span<const IntegrationPoint<4>> linear,
                      std::span<const Midsides> midsides);
};

/// int N_a N_b over a straight-edged element of volume 1, from int L^i = 6 i! / (i + 3)!.
/// @param nodes  of the element, 4 or 10  @param a, b  of these
[[nodiscard]] double productIntegral(std::size_t nodes, std::size_t a, std::size_t b);

}  // namespace palpate::solver
