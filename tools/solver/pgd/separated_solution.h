// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

namespace palpate::solver {

/// Pairs of a function of the place and a function of the parameters: u(x, s) = sum_k X_k(x) Y_k(s).
struct ScalarPairs {
  Eigen::MatrixXd X;  ///< dofs x n
  Eigen::MatrixXd Y;  ///< n x M
};

/// Result of one step of the enrichment.
struct EnrichmentStep {
  int pairs{0};          ///< so far
  int sweeps{0};         ///< alternating directions for the pairs of this step
  double residual{0.0};  ///< dual norm of the residual over that of the loads, estimated; in [0, 1] or nearly
  double spread{0.0};    ///< standard deviation of that estimate
  double seconds{0.0};   ///< since the start
};

/// u_i(s) = sum_k X_ik Y^c(i)_k(s), c(i) the component of unknown i.                              paper Eq. (3)
/// With one set of Y the pairs are scalar: u(s) = sum_k X_k Y_k(s).
struct SeparatedSolution {
  Eigen::MatrixXd X;               ///< dofs x n, m when Y has no unit
  std::vector<Eigen::MatrixXd> Y;  ///< 1 (scalar) or as many as components (Hadamard), n x M each
  std::vector<int> components;     ///< c(i) of every unknown; empty for scalar pairs
  std::vector<EnrichmentStep> history;
  double load_error{0.0};  ///< of the truncated load, relative, SeparatedLoad::truncationError

  [[nodiscard]] Eigen::Index pairs() const noexcept { return X.cols(); }
  /// Scalar pairs in one pair: the number of components.
  [[nodiscard]] int terms() const noexcept { return static_cast<int>(Y.size()); }
  /// Adds pairs. @param R  dofs x b  @param S  b x M for each set of Y
  void append(const Eigen::MatrixXd& R, const std::vector<Eigen::MatrixXd>& S);
  /// sum_s u(s) P(s, .), dofs x b. @param P  M x b. Cost O((dofs + M) n b)
  [[nodiscard]] Eigen::MatrixXd times(const Eigen::MatrixXd& P) const;
  /// Q^T u(s) for every s, b x M. @param Q  dofs x b. Cost O((dofs + M) n b)
  [[nodiscard]] Eigen::MatrixXd project(const Eigen::MatrixXd& Q) const;
  /// The same field in scalar pairs: n of them, or n times the number of components, those of one pair together.
  [[nodiscard]] ScalarPairs scalarPairs() const;
};

/// Columns R_j e_c: each column once per component, zero at the other components' unknowns; those of one R_j
/// adjoin.
///                                                                                              paper Eq. (6)
/// @param components  empty: R itself  @return dofs x (columns * count)
[[nodiscard]] Eigen::MatrixXd byComponent(const Eigen::MatrixXd& R, const std::vector<int>& components,
                                          int count);

}  // namespace palpate::solver
