// SPDX-License-Identifier: Apache-2.0
#include "tools/solver/fem/fe_model.h"

#include <stdexcept>
#include <string>
#include <utility>

#include "tools/solver/fem/linear_tetrahedra.h"

namespace palpate::solver {

FeModel::FeModel(std::vector<Vec3> nodes, std::vector<std::array<std::int32_t, 4>> tetrahedra,
                 std::vector<std::int32_t> fixed, Material material)
    : nodes_(std::move(nodes)),
      tetrahedra_(std::move(tetrahedra)),
      fixed_(std::move(fixed)),
      material_(std::move(material)) {
  material_.check(tetrahedra_.size());
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
  points_ = linearTetrahedra(nodes_, tetrahedra_, material_);
}

double FeModel::volume(int element) const noexcept {
  double volume = 0.0;
  for (const Point& point : pointsOf(element)) volume += point.weight;
  return volume;
}

Eigen::VectorXd FeModel::internalForce(const Eigen::VectorXd& u) const {
  Eigen::VectorXd f = Eigen::VectorXd::Zero(3 * nodeCount());
  std::visit([&](auto law) { addInternalForce<decltype(law)>(points(), u, f); }, material_.law);
  return f;
}

double FeModel::energy(const Eigen::VectorXd& u) const {
  return std::visit([&](auto law) { return elasticEnergy<decltype(law)>(points(), u); }, material_.law);
}

FeModel::ElementMatrix FeModel::elementTangent(int element, const Eigen::VectorXd& u) const {
  return std::visit([&](auto law) { return tangentOf<decltype(law)>(pointsOf(element), u); }, material_.law);
}

double FeModel::minDetF(const Eigen::VectorXd& u) const {
  return smallestDetF(points(), u);
}

}  // namespace palpate::solver
