// SPDX-License-Identifier: Apache-2.0
#include "tools/solver/pgd/recompression.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include "tools/solver/base/dense_decompositions.h"

namespace palpate::solver {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr Index kBlock = 32;          // columns orthonormalized at once
constexpr double kDependent = 1e-13;  // relative length below which a column depends on earlier ones

/// Orthonormalizes the columns of B, in two passes; old B = new B * R.
void orthonormalizeBlock(MatrixXd& B, const InnerProduct& A, const VectorXd& lengths, MatrixXd& R) {
  R = MatrixXd::Zero(B.cols(), B.cols());
  MatrixXd AB = MatrixXd::Zero(B.rows(), B.cols());
  for (Index j = 0; j < B.cols(); ++j) {
    for (int pass = 0; pass < 2; ++pass) {
      const VectorXd along = AB.leftCols(j).transpose() * B.col(j);
      B.col(j) -= B.leftCols(j) * along;
      R.col(j).head(j) += along;
    }
    const VectorXd Ab = A(B.col(j));
    const double length = std::sqrt(std::max(0.0, B.col(j).dot(Ab)));
    if (!(length > kDependent * lengths[j])) {
      B.col(j).setZero();
      continue;
    }
    B.col(j) /= length;
    AB.col(j) = Ab / length;
    R(j, j) = length;
  }
}

void check(const ScalarPairs& pairs, const VectorXd& weights, Index n) {
  if (pairs.X.cols() != pairs.Y.rows() || pairs.Y.cols() != weights.size())
    throw std::invalid_argument("pairs of " + std::to_string(pairs.X.cols()) + " and " +
                                std::to_string(pairs.Y.rows()) + " functions, " +
                                std::to_string(pairs.Y.cols()) + " columns with " +
                                std::to_string(weights.size()) + " weights do not fit");
  if (n < 1) throw std::invalid_argument("pairs to keep = " + std::to_string(n) + ", expected >= 1");
}

}  // namespace

InnerProduct energyProduct(const SparseMatrix& K) {
  return [&K](const MatrixXd& v) -> MatrixXd { return K * v; };
}

InnerProduct diagonalProduct(VectorXd weights) {
  return [w = std::move(weights)](const MatrixXd& v) -> MatrixXd { return w.asDiagonal() * v; };
}

OrthonormalBasis orthonormalize(const MatrixXd& V, const InnerProduct& A) {
  const Index n = V.cols();
  OrthonormalBasis basis{V, MatrixXd::Zero(n, n)};
  for (Index first = 0; first < n; first += kBlock) {
    const Index count = std::min(kBlock, n - first);
    MatrixXd B = V.middleCols(first, count);
    const VectorXd lengths = B.cwiseProduct(A(B)).colwise().sum().cwiseMax(0.0).cwiseSqrt().transpose();
    const auto earlier = basis.Q.leftCols(first);
    for (int pass = 0; pass < 2 && first > 0; ++pass) {
      const MatrixXd along = earlier.transpose() * A(B);
      B -= earlier * along;
      basis.R.block(0, first, first, count) += along;
    }
    MatrixXd R;
    orthonormalizeBlock(B, A, lengths, R);
    // A nearly dependent column is orthogonalized against the earlier ones once more.
    if (first > 0) {
      const MatrixXd along = earlier.transpose() * A(B);
      B -= earlier * along;
      basis.R.block(0, first, first, count) += along * R;
    }
    basis.Q.middleCols(first, count) = B;
    basis.R.block(first, first, count, count) = R;
  }
  return basis;
}

double Recompressed::truncation(Index n) const {
  const double all = singular_values.squaredNorm();
  const Index left = std::max<Index>(0, singular_values.size() - n);
  return all > 0.0 ? std::sqrt(singular_values.tail(left).squaredNorm() / all) : 0.0;
}

Recompressed recompress(const ScalarPairs& pairs, const InnerProduct& product, const VectorXd& weights,
                        Index n) {
  check(pairs, weights, n);
  const OrthonormalBasis x = orthonormalize(pairs.X, product);
  const OrthonormalBasis y = orthonormalize(pairs.Y.transpose(), diagonalProduct(weights));
  const SingularValues svd = singularValues(x.R * y.R.transpose());
  Recompressed result;
  result.singular_values = svd.values;
  const double least = 1e-15 * result.singular_values.head(1).sum();
  const Index rank = (result.singular_values.array() > least).count();
  const Index kept = std::min(n, rank);
  result.pairs.X = x.Q * svd.U.leftCols(kept);
  result.pairs.Y = result.singular_values.head(kept).asDiagonal() * (y.Q * svd.V.leftCols(kept)).transpose();
  return result;
}

}  // namespace palpate::solver
