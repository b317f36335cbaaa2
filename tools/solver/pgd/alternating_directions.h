// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "tools/solver/fem/cholesky.h"
#include "tools/solver/pgd/linear_pgd_options.h"
#include "tools/solver/pgd/load_separation.h"
#include "tools/solver/pgd/separated_solution.h"

namespace palpate::solver {

/// New pairs R(x) o S(s) on top of u^n, found together.
struct NewPairs {
  Eigen::MatrixXd R;               ///< dofs x b; each component of each column of energy norm 1
  std::vector<Eigen::MatrixXd> S;  ///< b x M for each component, m
  int sweeps{0};
  double energy{0.0};  ///< sum_s w_s |R o S(s)|^2 in the energy norm, m N (times the unit of w)
};

/// The fixed point of one enrichment, paper Sections 2.1 and 2.2, for scalar pairs (several at once) and for
/// component-wise ones (one at a time). One thread at a time; the solves use `workers` threads.
class AlternatingDirections {
 public:
  AlternatingDirections(const SparseMatrix& K, const SeparatedLoad& load, const Eigen::VectorXd& weights,
                        const LinearPgdOptions& options, std::vector<int> components);

  /// From random S to the fixed point, or to max_sweeps. No columns when the residual is zero.
  [[nodiscard]] NewPairs enrich(const SeparatedSolution& u, int block);

  /// S-step: a(R_i e_i, R_j e_j) S_j = l_s(R_i e_i) - a(R_i e_i, u^n(s)) for every s.      paper Eqs. (6)-(10)
  /// The gain in energy is kept in pairs.energy. @param[in,out] pairs  R is read, S written
  void stepS(const SeparatedSolution& u, NewPairs& pairs) const;
  /// R-step: blocks K_ij int S_i S_j ds, right-hand side int S_i (l_s - K u^n)_i ds.      paper Eqs. (11)-(12)
  /// Normalizes R. @param[in,out] pairs  S is read, R written
  void stepR(const SeparatedSolution& u, NewPairs& pairs);

  /// K^-1 B; the workers share the columns.
  [[nodiscard]] Eigen::MatrixXd solve(const Eigen::MatrixXd& B) const;
  [[nodiscard]] int componentCount() const noexcept { return count_; }

 private:
  [[nodiscard]] NewPairs randomPairs(int block);
  void stepScalarR(const SeparatedSolution& u, NewPairs& pairs) const;
  void stepHadamardR(const SeparatedSolution& u, NewPairs& pairs);
  [[nodiscard]] double change(const NewPairs& before, const NewPairs& after) const;

  const SparseMatrix& K_;
  const SeparatedLoad& load_;
  const Eigen::VectorXd& weights_;
  LinearPgdOptions options_;
  std::vector<int> components_;  // empty for scalar pairs
  int count_;
  Cholesky factor_;
  std::unique_ptr<Cholesky> blocks_factor_;  // Hadamard: of K_ij int S_i S_j, new in every sweep
  SparseMatrix blocks_;
  unsigned drawn_{0};
};

}  // namespace palpate::solver
