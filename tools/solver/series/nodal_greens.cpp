// SPDX-License-Identifier: Apache-2.0
#include "tools/solver/series/nodal_greens.h"

namespace palpate::solver {

NodalGreens::NodalGreens(const FeModel& model, const Cholesky& factor, const PatchSurface& surface)
    : model_(model),
      surface_(surface),
      solver_(factor),
      row_of_(static_cast<std::size_t>(model.dofCount())),
      field_(Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(3 * surface.nodes.size()), 3)) {
  for (std::size_t row = 0; row < row_of_.size(); ++row)
    row_of_[static_cast<std::size_t>(factor.order()[row])] = row;
}

void NodalGreens::solve(std::span<const std::int32_t> nodes) {
  lanes_ = (3 * nodes.size() + kLanes - 1) / kLanes;
  solution_.assign(row_of_.size() * lanes_, Lanes{});
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const int dof = model_.dof(surface_.nodes[static_cast<std::size_t>(nodes[i])]);
    for (int c = 0; c < 3 && dof >= 0; ++c) rowOf(dof + c)[3 * i + static_cast<std::size_t>(c)] = 1.0;
  }
  solver_.solve(solution_, static_cast<int>(lanes_));
}

const Eigen::MatrixXd& NodalGreens::of(std::size_t which) {
  for (std::size_t j = 0; j < surface_.nodes.size(); ++j) {
    const int dof = model_.dof(surface_.nodes[j]);
    for (int c = 0; c < 3 && dof >= 0; ++c)  // clamped: zero
      field_.row(static_cast<Eigen::Index>(3 * j) + c) =
          Eigen::Map<const Eigen::RowVector3d>(rowOf(dof + c) + 3 * which);
  }
  return field_;
}

}  // namespace palpate::solver
