// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "tools/examine/certify/touch_sampler.h"
#include "tools/examine/query/full_solution.h"
#include "tools/solver/fem/cholesky.h"
#include "tools/solver/fem/newton.h"

namespace palpate::certify {

/// Touches solved by Newton's method on the mesh in the model file, several at a time. docs/design.md, Certificate
/// Each starts from the series of its own patch. No model stores that series. Where it leads to no solution, or to one with an
/// element inside out, Newton's method starts at rest, in load steps. Its tangent's factor is held while it serves.
class ReferenceSolver {
 public:
  /// Borrows the organ. Factorizes K_T(0), and analyses it for each thread. @param threads  at least 1
  /// @throw std::runtime_error when K_T(0) is not positive definite
  ReferenceSolver(const query::Organ& organ, double patch_radius, int threads);
  ~ReferenceSolver();

  /// The full solution of a touch, or of several tools at once. @param start  3 N, m, the sum of their starts()
  /// @param thread  0-based, each from one thread at once  @throw std::bad_alloc
  /// @return nothing where Newton's method does not converge, or only to an element inside out; `patch` and `d` are the first tool's
  [[nodiscard]] std::optional<query::FullSolution> solve(std::span<const Touch> touches,
                                                         const Eigen::VectorXd& start, int thread);
  /// Where Newton's method begins: the series of degree 3 of each touch, on all threads.
  [[nodiscard]] std::vector<Eigen::VectorXd> starts(std::span<const Touch> touches);

 private:
  [[nodiscard]] solver::Patch patchOf(const Touch& touch) const;

  const query::Organ& organ_;
  double patch_radius_;
  solver::Cholesky at_rest_;
  std::vector<std::unique_ptr<solver::NewtonSolver>> newton_;  // of each thread
};

}  // namespace palpate::certify
