// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "tools/solver/fem/cholesky.h"
#include "tools/solver/fem/fe_model.h"
#include "tools/solver/fem/ordered_solver.h"
#include "tools/solver/fem/patch.h"

namespace palpate::solver {

/// Nodal Green's functions W_i = K0^-1 E_i of surface nodes, at the surface nodes: the columns of the surface's
/// compliance. A patch's linear answer is their weighted sum, whatever its place.          docs/design.md, Parts
/// One object per thread; the factor is shared.
class NodalGreens {
 public:
  static constexpr std::size_t kMost = 32;  ///< nodes at once

  /// @param factor  of K_T(0)
  NodalGreens(const FeModel& model, const Cholesky& factor, const PatchSurface& surface);

  /// @param nodes  1 to kMost surface nodes; the field of a clamped one is zero
  void solve(std::span<const std::int32_t> nodes);
  /// Displacement of all surface nodes by unit forces at node number `which` of the last solve(): 3 Ns x 3, m/N.
  [[nodiscard]] const Eigen::MatrixXd& of(std::size_t which);

 private:
  /// Three columns for each node.
  [[nodiscard]] double* rowOf(int dof) {
    return reinterpret_cast<double*>(solution_.data() + row_of_[static_cast<std::size_t>(dof)] * lanes_);
  }

  const FeModel& model_;
  const PatchSurface& surface_;
  OrderedSolver solver_;
  std::vector<std::size_t> row_of_;  // of the factor, by unknown
  LaneVector solution_;              // row by row
  std::size_t lanes_{0};             // of a row
  Eigen::MatrixXd field_;            // 3 Ns x 3
};

}  // namespace palpate::solver
