// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "tools/solver/pgd/load_separation.h"
#include "tools/solver/pgd/separated_solution.h"

namespace palpate::solver {

/// Dual norm of the residual l - K u^n over that of l, in the mean over the positions, without M solves.
///   sum_s w_s |u_s - u^n_s|^2  =  E |sum_s sqrt(w_s) z_s (u_s - u^n_s)|^2,  z_s independent N(0, 1)
/// K times the sum is a combination of loads and of pairs, so each probe z costs one solve in all.
/// Hutchinson's estimator of a trace; the norm of the loads is 2 l(u^n) - |u^n|^2 + the estimate, so it
/// becomes sharper as u^n improves.
class ResidualEstimate {
 public:
  struct Result {
    double relative{1.0};
    double spread{0.0};  ///< standard deviation of `relative`, from the scatter of the probes
  };

  /// @param solve  B -> K^-1 B
  ResidualEstimate(const SparseMatrix& K, const SeparatedLoad& load, const Eigen::VectorXd& weights,
                   int probes, unsigned seed,
                   const std::function<Eigen::MatrixXd(const Eigen::MatrixXd&)>& solve);

  /// Cost O((dofs + M) n probes). @param captured  2 l(u^n) - |u^n|^2 summed over the positions
  [[nodiscard]] Result operator()(const SeparatedSolution& u, double captured) const;

 private:
  const SparseMatrix& K_;
  Eigen::MatrixXd P_;  // M x probes: W^1/2 z
  Eigen::MatrixXd V_;  // dofs x probes: K^-1 L P
};

}  // namespace palpate::solver
