// SPDX-License-Identifier: Apache-2.0
#include "tools/solver/fem/quadratic_tetrahedra.h"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>

#include "tools/mesh/tet_mesh.h"

namespace palpate::solver {

namespace {

using Barycentric = Eigen::Vector4d;
using mesh::kTetEdges;

Eigen::Matrix<double, 10, 3> gradients(const Barycentric& L, const Eigen::Matrix<double, 4, 3>& g) {
  Eigen::Matrix<double, 10, 3> all;
  for (Eigen::Index a = 0; a < 4; ++a) all.row(a) = (4.0 * L[a] - 1.0) * g.row(a);
  for (std::size_t e = 0; e < kTetEdges.size(); ++e) {
    const auto [a, b] = kTetEdges[e];
    all.row(4 + static_cast<Eigen::Index>(e)) = 4.0 * (L[a] * g.row(b) + L[b] * g.row(a));
  }
  return all;
}

std::array<Barycentric, 4> gaussPoints() {
  constexpr double kFar = 0.5854101966249685,
                   kNear = 0.1381966011250105;  // (5 + 3 sqrt 5) / 20, (5 - sqrt 5) / 20
  std::array<Barycentric, 4> points;
  for (std::size_t i = 0; i < points.size(); ++i)
    points[i] =
        Barycentric::Constant(kNear) + (kFar - kNear) * Barycentric::Unit(static_cast<Eigen::Index>(i));
  return points;
}

std::array<Barycentric, 10> nodePoints() {
  std::array<Barycentric, 10> points;
  for (Eigen::Index a = 0; a < 4; ++a) points[static_cast<std::size_t>(a)] = Barycentric::Unit(a);
  for (std::size_t e = 0; e < kTetEdges.size(); ++e)
    points[4 + e] = 0.5 * (Barycentric::Unit(kTetEdges[e][0]) + Barycentric::Unit(kTetEdges[e][1]));
  return points;
}

/// The nodes of an element, checked.
std::array<std::int32_t, 10> nodesOf(std::span<const Vec3> nodes, const std::array<std::int32_t, 4>& corners,
                                     const QuadraticTetrahedra::Midsides& midsides, std::size_t element) {
  constexpr double kOff = 1e-6;  // of the edge: what rounding of a mesh file may do
  std::array<std::int32_t, 10> all{};
  std::copy(midsides.begin(), midsides.end(), std::copy(corners.begin(), corners.end(), all.begin()));
  const std::string name = "tetrahedron " + std::to_string(element) + ": ";
  for (std::size_t e = 0; e < midsides.size(); ++e) {
    const std::int32_t node = midsides[e];
    if (node < 0 || node >= static_cast<std::int32_t>(nodes.size()))
      throw std::invalid_argument(name + "node " + std::to_string(node) + " of " +
                                  std::to_string(nodes.size()));
    const auto end = [&](std::size_t i) {
      return nodes[static_cast<std::size_t>(corners[static_cast<std::size_t>(kTetEdges[e][i])])];
    };
    const double off = (nodes[static_cast<std::size_t>(node)] - 0.5 * (end(0) + end(1))).norm();
    if (!(off <= kOff * (end(1) - end(0)).norm()))
      throw std::invalid_argument(name + "node " + std::to_string(node) + " is " + std::to_string(off) +
                                  " m from the middle of its edge");
  }
  return all;
}

}  // namespace

double productIntegral(std::size_t nodes, std::size_t a, std::size_t b) {
  if (nodes == 4) return a == b ? 0.1 : 0.05;
  if (a > b) std::swap(a, b);
  const auto edge = [](std::size_t node) { return kTetEdges[node - 4]; };
  const auto shares = [&](std::size_t node, const std::array<int, 2>& other) {
    const auto [i, j] = edge(node);
    return i == other[0] || i == other[1] || j == other[0] || j == other[1];
  };
  const auto ends = [&](std::size_t corner) {
    const auto [i, j] = edge(b);
    return static_cast<int>(corner) == i || static_cast<int>(corner) == j;
  };
  if (b < 4) return (a == b ? 6.0 : 1.0) / 420.0;
  if (a < 4) return (ends(a) ? -4.0 : -6.0) / 420.0;
  if (a == b) return 32.0 / 420.0;
  return (shares(a, edge(b)) ? 16.0 : 8.0) / 420.0;
}

QuadraticTetrahedra::QuadraticTetrahedra(std::span<const Vec3> nodes,
                                         std::span<const IntegrationPoint<4>> linear,
                                         std::span<const Midsides> midsides) {
  if (linear.size() != midsides.size())
    throw std::invalid_argument(std::to_string(midsides.size()) + " mid-sides for " +
                                std::to_string(linear.size()) + " tetrahedra");
  const std::array<Barycentric, 4> gauss = gaussPoints();
  const std::array<Barycentric, 10> at_nodes = nodePoints();
  for (std::size_t e = 0; e < linear.size(); ++e) {
    const IntegrationPoint<4>& whole = linear[e];
    IntegrationPoint<10> point{
        nodesOf(nodes, whole.nodes, midsides[e], e), {}, 0.25 * whole.weight, whole.lame, whole.law};
    for (const Barycentric& L : gauss) {
      point.gradients = gradients(L, whole.gradients);
      points.push_back(point);
      det_points.push_back(point);
    }
    point.weight = 0.0;
    for (const Barycentric& L : at_nodes) {
      point.gradients = gradients(L, whole.gradients);
      det_points.push_back(point);
    }
  }
}

}  // namespace palpate::solver
