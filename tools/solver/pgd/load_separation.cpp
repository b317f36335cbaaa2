// SPDX-License-Identifier: Apache-2.0
#include "tools/solver/pgd/load_separation.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>
#include <string>

#include "tools/solver/base/dense_decompositions.h"

namespace palpate::solver {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;

constexpr Index kOversampling = 20;
constexpr int kPowerIterations = 6;

MatrixXd orthonormalColumns(const MatrixXd& V) {
  const Eigen::HouseholderQR<MatrixXd> qr(V);
  return qr.householderQ() * MatrixXd::Identity(V.rows(), V.cols());
}

/// Orthonormal columns close to the `count` strongest directions of A's range.
MatrixXd strongRange(const SparseMatrix& A, Index count, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  MatrixXd V = MatrixXd::NullaryExpr(A.cols(), count, [&] { return normal(random); });
  MatrixXd Q = orthonormalColumns(A * V);
  for (int i = 0; i < kPowerIterations; ++i) {
    V = orthonormalColumns(A.transpose() * Q);
    Q = orthonormalColumns(A * V);
  }
  return Q;
}

}  // namespace

SeparatedLoad::SeparatedLoad(const SparseMatrix& loads, const Eigen::VectorXd& weights, int terms,
                             unsigned seed) {
  if (loads.cols() != weights.size())
    throw std::invalid_argument("loads at " + std::to_string(loads.cols()) + " positions, but " +
                                std::to_string(weights.size()) + " weights");
  if (terms < 0) throw std::invalid_argument("load terms = " + std::to_string(terms) + ", expected >= 0");
  const Index most = std::min(loads.rows(), loads.cols());
  loads_ = loads;
  if (terms == 0 || terms >= most) return;
  const Eigen::VectorXd root = weights.cwiseSqrt();
  const SparseMatrix A = loads * root.asDiagonal();
  const MatrixXd Q = strongRange(A, std::min<Index>(terms + kOversampling, most), seed);
  const MatrixXd B = Q.transpose() * A;
  const SingularValues svd = singularValues(B);
  f_ = Q * svd.U.leftCols(terms);
  g_ = svd.values.head(terms).asDiagonal() * svd.V.leftCols(terms).transpose() *
       root.cwiseInverse().asDiagonal();
  const double kept = svd.values.head(terms).squaredNorm();
  error_ = std::sqrt(std::max(0.0, 1.0 - kept / A.squaredNorm()));
  truncated_ = true;
  loads_ = SparseMatrix();
}

MatrixXd SeparatedLoad::times(const MatrixXd& P) const {
  if (truncated_) return f_ * (g_ * P);
  return loads_ * P;
}

MatrixXd SeparatedLoad::project(const MatrixXd& Q) const {
  if (truncated_) return (Q.transpose() * f_) * g_;
  return (loads_.transpose() * Q).transpose();
}

}  // namespace palpate::solver
