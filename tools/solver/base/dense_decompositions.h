// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

namespace palpate::solver {

// Eigen's decompositions, compiled once: a file that instantiates them takes half a minute to build.
// All throw std::runtime_error for a matrix that is not finite or does not converge.

/// A = U diag(values) V^T.
struct SingularValues {
  Eigen::MatrixXd U;       ///< m x k, k = min(m, n)
  Eigen::VectorXd values;  ///< k, falling
  Eigen::MatrixXd V;       ///< n x k
};

/// Of any m x n matrix.
[[nodiscard]] SingularValues singularValues(const Eigen::MatrixXd& A);

/// A = V diag(values) V^T.
struct Eigenpairs {
  Eigen::MatrixXd V;       ///< n x n, orthonormal columns
  Eigen::VectorXd values;  ///< n, falling
};

/// Of a symmetric n x n matrix.
[[nodiscard]] Eigenpairs eigenpairs(const Eigen::MatrixXd& A);

/// Of a symmetric n x n matrix, falling.
[[nodiscard]] Eigen::VectorXd eigenvalues(const Eigen::MatrixXd& A);

}  // namespace palpate::solver
