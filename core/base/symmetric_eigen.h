// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Eigenvalues>

#include "core/base/types.h"

namespace palpate {

/// A = V diag(l) V^T.
template <class Matrix>
struct SymmetricEigen {
  Matrix vectors;
  Eigen::Matrix<double, Matrix::RowsAtCompileTime, 1> values;
};

// Trusted: Eigen's closed form has a fixed size and no loop to converge, but takes the largest number of a matrix
// through a function pointer, behind which the compiler does not look. RealtimeSanitizer does, when it runs.
PALPATE_TRUSTED_BEGIN
/// Of a symmetric 2 x 2 or 3 x 3 matrix, in closed form, values rising. Real-time: yes.
template <class Matrix>
[[nodiscard]] SymmetricEigen<Matrix> symmetricEigen(const Matrix& A) noexcept PALPATE_NONBLOCKING {
  static_assert(Matrix::RowsAtCompileTime == 2 || Matrix::RowsAtCompileTime == 3);
  Eigen::SelfAdjointEigenSolver<Matrix> eigen;
  eigen.computeDirect(A);
  return {eigen.eigenvectors(), eigen.eigenvalues()};
}
PALPATE_TRUSTED_END

}  // namespace palpate
