// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "tools/solver/fem/cholesky.h"

namespace palpate::solver {

/// The regularized Dirac loads of all positions, in separated form:
///   l(x, s) = sum_i f^i(x) g^i(s),  i = 1 .. m                                                  paper Eq. (2)
/// The paper does not say how to find f and g. Here they are the best m terms in the mean over s (SVD of the
/// nodal forces in the weights of the positions). Without truncation the sparse loads themselves are kept.
class SeparatedLoad {
 public:
  /// @param loads  l_s, dofs x M, N  @param weights  M, > 0
  /// @param terms  m; 0, or the rank of the loads or more: no truncation
  /// @throw std::invalid_argument when sizes do not fit or m < 0
  /// Cost O(nonzeros m) and an SVD of (m + 20) x M; randomized, the same for the same seed.
  SeparatedLoad(const SparseMatrix& loads, const Eigen::VectorXd& weights, int terms, unsigned seed = 1);

  [[nodiscard]] Eigen::Index dofs() const noexcept { return truncated_ ? f_.rows() : loads_.rows(); }
  [[nodiscard]] Eigen::Index positions() const noexcept { return truncated_ ? g_.cols() : loads_.cols(); }
  /// m, or 0 without truncation.
  [[nodiscard]] Eigen::Index terms() const noexcept { return f_.cols(); }
  /// sqrt(sum_s w_s |l_s - sum f g|^2 / sum_s w_s |l_s|^2) in nodal forces; good to 1e-8.
  [[nodiscard]] double truncationError() const noexcept { return error_; }

  /// sum_s l(s) P(s, .), dofs x b. @param P  M x b
  [[nodiscard]] Eigen::MatrixXd times(const Eigen::MatrixXd& P) const;
  /// Q^T l(s) for every s, b x M. @param Q  dofs x b
  [[nodiscard]] Eigen::MatrixXd project(const Eigen::MatrixXd& Q) const;

 private:
  bool truncated_{false};
  double error_{0.0};
  SparseMatrix loads_;  // without truncation
  Eigen::MatrixXd f_;   // dofs x m, orthonormal
  Eigen::MatrixXd g_;   // m x M, N
};

}  // namespace palpate::solver
