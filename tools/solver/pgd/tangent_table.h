// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <vector>

#include "tools/solver/pgd/parametric_problem.h"

namespace palpate::solver {

/// K_T(u_s) of all positions at one load level. It keeps the values of as many positions as the memory
/// allows, and assembles the others at each request. One thread per worker number.
class TangentTable {
 public:
  using View = Eigen::Map<const SparseMatrix>;

  /// @param bytes  limit of the kept values
  TangentTable(const ParametricProblem& problem, double bytes, int workers);

  /// Whether every displacement has K_T(0) from now on.
  void holdConstant(bool constant) noexcept { constant_ = constant; }
  [[nodiscard]] bool constant() const noexcept { return constant_; }

  /// Assembles K_T(u) for position s. The view is valid until this worker's next call.
  View assemble(int worker, int s, const Eigen::VectorXd& u);
  /// The matrix of the last assemble() of s. @param u the same displacement, called only when s is not kept
  template <typename Displacement>
  View at(int worker, int s, const Displacement& u) {
    return constant_ || s < kept() ? view(worker, s) : assemble(worker, s, u());
  }

 private:
  [[nodiscard]] int kept() const noexcept { return static_cast<int>(values_.size()); }
  [[nodiscard]] View view(int worker, int s) const;

  const ParametricProblem& problem_;
  bool constant_{true};
  std::vector<Eigen::VectorXd> values_;  ///< of the first positions
  std::vector<SparseMatrix> work_;       ///< one per worker
};

}  // namespace palpate::solver
