// SPDX-License-Identifier: Apache-2.0
#include "tools/solver/fem/fe_model.h"

#include <stdexcept>
#include <string>
#include <utility>

#include "tools/solver/fem/linear_tetrahedra.h"
#include "tools/solver/fem/quadratic_tetrahedra.h"

namespace palpate::solver {

namespace {

/// The points of one element.
template <int N>
std::span<const IntegrationPoint<N>> pointsOf(const std::vector<IntegrationPoint<N>>& points, int element) {
  constexpr std::size_t kEach = N == 4 ? 1 : 4;
  return std::span(points).subspan(static_cast<std::size_t>(element) * kEach, kEach);
}

}  // namespace

FeModel::FeModel(std::vector<Vec3> nodes, Tetrahedra tetrahedra, std::vector<std::int32_t> fixed,
                 Material material)
    : nodes_(std::move(nodes)),
      tetrahedra_(std::move(tetrahedra)),
      fixed_(std::move(fixed)),
      material_(std::move(material)) {
  material_.check(tetrahedra_.corners.size());
  dofs_.assign(nodes_.size(), 0);
  for (const std::int32_t node : fixed_) {
    if (node < 0 || node >= nodeCount())
      throw std::invalid_argument("fixed node " + std::to_string(node) + " of " +
                                  std::to_string(nodeCount()));
    dofs_[index(node)] = -1;
  }
  for (int& dof : dofs_) {
    if (dof < 0) continue;
    dof = dof_count_;
    dof_count_ += 3;
  }
  std::vector<IntegrationPoint<4>> linear = linearTetrahedra(nodes_, tetrahedra_.corners, material_);
  if (!isQuadratic()) {
    points_ = std::move(linear);
    return;
  }
  QuadraticTetrahedra quadratic(nodes_, linear, tetrahedra_.midsides);
  points_ = std::move(quadratic.points);
  det_points_ = std::move(quadratic.det_points);
}

std::span<const std::int32_t> FeModel::elementNodes(int element) const noexcept {
  return std::visit(
      [&](const auto& all) -> std::span<const std::int32_t> { return pointsOf(all, element).front().nodes; },
      points_);
}

double FeModel::volume(int element) const noexcept {
  double volume = 0.0;
  std::visit(
      [&](const auto& all) {
        for (const auto& point : pointsOf(all, element)) volume += point.weight;
      },
      points_);
  return volume;
}

Eigen::VectorXd FeModel::internalForce(const Eigen::VectorXd& u) const {
  Eigen::VectorXd f = Eigen::VectorXd::Zero(3 * nodeCount());
  std::visit([&](auto law, const auto& all) { addInternalForce<decltype(law)>(std::span(all), u, f); },
             material_.law, points_);
  return f;
}

double FeModel::energy(const Eigen::VectorXd& u) const {
  return std::visit(
      [&](auto law, const auto& all) { return elasticEnergy<decltype(law)>(std::span(all), u); },
      material_.law, points_);
}

FeModel::ElementMatrix FeModel::elementTangent(int element, const Eigen::VectorXd& u) const {
  return std::visit(
      [&](auto law, const auto& all) -> ElementMatrix {
        return tangentOf<decltype(law)>(pointsOf(all, element), u);
      },
      material_.law, points_);
}

double FeModel::minDetF(const Eigen::VectorXd& u) const {
  return std::visit([&](const auto& all) { return smallestDetF(std::span(all), u); }, detPoints());
}

}  // namespace palpate::solver
