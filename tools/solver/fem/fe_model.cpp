// SPDX-License-Identifier: Apache-2.0
#include "tools/solver/fem/fe_model.h"

#include <algorithm>
#include <cmath>
#include <map>
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
                 Material material, std::vector<Spring> springs)
    : nodes_(std::move(nodes)),
      tetrahedra_(std::move(tetrahedra)),
      fixed_(std::move(fixed)),
      material_(std::move(material)),
      springs_(std::move(springs)) {
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
  } else {
    QuadraticTetrahedra quadratic(nodes_, linear, tetrahedra_.midsides);
    points_ = std::move(quadratic.points);
    det_points_ = std::move(quadratic.det_points);
  }
  findElementsOfSprings();
}

void FeModel::findElementsOfSprings() {
  std::map<std::int32_t, double> waiting;
  for (const auto& [node, stiffness] : springs_) {
    if (node < 0 || node >= nodeCount() || !(stiffness > 0.0) || !std::isfinite(stiffness))
      throw std::invalid_argument("spring of " + std::to_string(stiffness) + " N/m at node " +
                                  std::to_string(node) + " of " + std::to_string(nodeCount()));
    waiting[node] += stiffness;
  }
  for (int e = 0; e < elementCount() && !waiting.empty(); ++e) {
    int place = 0;
    for (const std::int32_t node : elementNodes(e)) {
      if (const auto spring = waiting.find(node); spring != waiting.end()) {
        element_springs_.push_back({e, place, spring->second});
        waiting.erase(spring);
      }
      ++place;
    }
  }
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
  std::visit(
      [&](const auto& all) {
        forEachRun(std::span(all),
                   [&](auto law, const auto& run) { addInternalForce<decltype(law)>(run, u, f); });
      },
      points_);
  for (const auto& [node, stiffness] : springs_) f.segment<3>(3 * node) += stiffness * u.segment<3>(3 * node);
  return f;
}

double FeModel::energy(const Eigen::VectorXd& u) const {
  double energy = 0.0;
  std::visit(
      [&](const auto& all) {
        forEachRun(std::span(all),
                   [&](auto law, const auto& run) { energy += elasticEnergy<decltype(law)>(run, u); });
      },
      points_);
  for (const auto& [node, stiffness] : springs_)
    energy += 0.5 * stiffness * u.segment<3>(3 * node).squaredNorm();
  return energy;
}

FeModel::ElementMatrix FeModel::elementTangent(int element, const Eigen::VectorXd& u) const {
  ElementMatrix K = std::visit(
      [&](auto law, const auto& all) -> ElementMatrix {
        return tangentOf<decltype(law)>(pointsOf(all, element), u);
      },
      material_.lawIn(index(element)), points_);
  const auto [first, last] =
      std::equal_range(element_springs_.begin(), element_springs_.end(), ElementSpring{element, 0, 0.0},
                       [](const ElementSpring& l, const ElementSpring& r) { return l.element < r.element; });
  for (auto spring = first; spring != last; ++spring)
    for (int c = 0; c < 3; ++c) K(3 * spring->node + c, 3 * spring->node + c) += spring->stiffness;
  return K;
}

double FeModel::minDetF(const Eigen::VectorXd& u) const {
  return std::visit([&](const auto& all) { return smallestDetF(std::span(all), u); }, detPoints());
}

}  // namespace palpate::solver
