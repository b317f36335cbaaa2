// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

#include "tools/solver/fem/material.h"

namespace palpate::solver {

using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;

/// One integration point of an element of N nodes: all that the kernels know of the mesh. A kind of element is a
/// function that makes these. Sums below run over points, element by element, of one law L; u, f: 3 a node, of all nodes.
template <int N>
struct IntegrationPoint {
  std::array<std::int32_t, N> nodes;
  Eigen::Matrix<double, N, 3> gradients;  ///< row a: dN_a/dX, 1/m
  double weight;                          ///< of the integral, m^3
  Lame lame;
  Law law{};
};

/// The end of the points after `first` that have its law.
template <int N>
[[gnu::always_inline]] inline const IntegrationPoint<N>* endOfRun(const IntegrationPoint<N>* first,
                                                                  const IntegrationPoint<N>* end) noexcept {
  const auto law = first->law.index();
  while (first != end && first->law.index() == law) ++first;
  return first;
}

/// Calls body(law, points) for each run of points with one law.
template <int N, typename Body>
void forEachRun(std::span<const IntegrationPoint<N>> points, const Body& body) {
  while (!points.empty()) {
    const auto count =
        static_cast<std::size_t>(endOfRun(points.data(), points.data() + points.size()) - points.data());
    std::visit([&](auto law) { body(law, points.first(count)); }, points.front().law);
    points = points.subspan(count);
  }
}

/// H = du/dX, 3 x 3.
template <int N>
[[nodiscard]] Mat3 displacementGradient(const IntegrationPoint<N>& point, const Eigen::VectorXd& u) noexcept {
  Mat3 H = Mat3::Zero();
  for (int a = 0; a < N; ++a)
    H += u.segment<3>(3 * point.nodes[static_cast<std::size_t>(a)]) * point.gradients.row(a);
  return H;
}

/// f += nodal forces int P(u) : grad delta, N.                                     docs/design.md, Series
template <typename L, int N>
void addInternalForce(std::span<const IntegrationPoint<N>> points, const Eigen::VectorXd& u,
                      Eigen::VectorXd& f) {
  for (const IntegrationPoint<N>& point : points) {
    const Mat3 P = L::stress(point.lame, displacementGradient(point, u));
    for (int a = 0; a < N; ++a)
      f.segment<3>(3 * point.nodes[static_cast<std::size_t>(a)]) +=
          point.weight * (P * point.gradients.row(a).transpose());
  }
}

/// int Psi(u), J.
template <typename L, int N>
[[nodiscard]] double elasticEnergy(std::span<const IntegrationPoint<N>> points, const Eigen::VectorXd& u) {
  double total = 0.0;
  for (const IntegrationPoint<N>& point : points)
    total += point.weight * L::energy(point.lame, displacementGradient(point, u));
  return total;
}

/// Consistent tangent of one element, 3 N x 3 N node-interleaved, N/m. @param points  of that element, at least one
template <typename L, int N>
[[nodiscard]] Eigen::Matrix<double, 3 * N, 3 * N> tangentOf(std::span<const IntegrationPoint<N>> points,
                                                            const Eigen::VectorXd& u) {
  const auto at = [&](const IntegrationPoint<N>& point) {
    return (point.weight * L::tangent(point.lame, displacementGradient(point, u), point.gradients)).eval();
  };
  Eigen::Matrix<double, 3 * N, 3 * N> K = at(points.front());
  for (const IntegrationPoint<N>& point : points.subspan(1)) K += at(point);
  return K;
}

/// Smallest det F over the points.
template <int N>
[[nodiscard]] double smallestDetF(std::span<const IntegrationPoint<N>> points, const Eigen::VectorXd& u) {
  double smallest = std::numeric_limits<double>::infinity();
  for (const IntegrationPoint<N>& point : points)
    smallest = std::min(smallest, (Mat3::Identity() + displacementGradient(point, u)).determinant());
  return smallest;
}

}  // namespace palpate::solver
