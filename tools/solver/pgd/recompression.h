// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <functional>

#include "tools/solver/fem/cholesky.h"
#include "tools/solver/pgd/separated_solution.h"

namespace palpate::solver {

/// v -> A v, columns at a time, for a symmetric A >= 0 that measures lengths: |v|^2 = v^T A v.
using InnerProduct = std::function<Eigen::MatrixXd(const Eigen::MatrixXd&)>;

/// Energy product a(u, v) = u^T K v. K must outlive the result.
[[nodiscard]] InnerProduct energyProduct(const SparseMatrix& K);
/// Weighted product, say by the areas of surface rows.
[[nodiscard]] InnerProduct diagonalProduct(Eigen::VectorXd weights);

struct OrthonormalBasis {
  Eigen::MatrixXd Q;  ///< rows x n; orthonormal; zero where a column of V depends on earlier ones
  Eigen::MatrixXd R;  ///< n x n, upper triangular: V = Q R
};

/// V = Q R with Q^T A Q = 1, by blocked Gram-Schmidt, every block twice.
/// Cost 4 rows n^2, two products with A per column.
[[nodiscard]] OrthonormalBasis orthonormalize(const Eigen::MatrixXd& V, const InnerProduct& A);

struct Recompressed {
  ScalarPairs pairs;                ///< X orthonormal in the inner product; rows of Y orthogonal, by energy
  Eigen::VectorXd singular_values;  ///< of the given pairs, falling; the first are the norms of the rows of Y

  /// Norm of the error of n pairs over that of the given pairs.
  [[nodiscard]] double truncation(Eigen::Index n) const;
};

/// The best n pairs for the field of the given pairs: QR of both factors, SVD of the small core, cut.
/// docs/design.md, Reproduction
/// @param pairs  X rows x k, Y k x columns: positions, or positions times coefficients
/// @param product  in x  @param weights  of the columns of Y, > 0  @param n  at most; fewer where the rank is less
/// @throw std::invalid_argument when sizes do not fit or n < 1
/// Cost O((rows + columns) k^2 + k^3).
[[nodiscard]] Recompressed recompress(const ScalarPairs& pairs, const InnerProduct& product,
                                      const Eigen::VectorXd& weights, Eigen::Index n);

}  // namespace palpate::solver
