// SPDX-License-Identifier: Apache-2.0
// The basis of the modes: found, extended, kept orthonormal.                              docs/design.md, Parts
#include <Eigen/Cholesky>
#include <random>

#include "tools/solver/base/dense_decompositions.h"
#include "tools/solver/fit/far_field_fit.h"
#include "tools/solver/fit/normal_equations.h"

namespace palpate::solver {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::MatrixXf;

/// Random numbers for the columns of a chunk, (sources C) x count, whitened.
MatrixXf FarFieldFit::noise(Sources chunk, Index count) const {
  MatrixXf all(static_cast<Index>(chunk.size()) * coefficients_, count);
  for (std::size_t i = 0; i < chunk.size(); ++i) {
    std::mt19937 random(static_cast<std::mt19937::result_type>(chunk[i]));
    std::normal_distribution<float> normal;
    all.middleRows(static_cast<Index>(i) * coefficients_, coefficients_) =
        whitening(chunk[i]) * MatrixXf::NullaryExpr(coefficients_, count, [&] { return normal(random); });
  }
  return all;
}

/// A first basis: the table times random numbers (a randomized range finder, one pass).
void FarFieldFit::sketch() {
  for (Worker& worker : workers_) worker.row_rhs = MatrixXd::Zero(rows_, modes_);
  forBlocks(active_, kChunk, [&](Worker& worker, Sources chunk) {
    read(chunk, worker);
    const Eigen::Map<const MatrixXf> A(worker.fields.data(), rows_, worker.weighted.cols());
    for (std::size_t i = 0; i < chunk.size(); ++i)
      if (!A.middleCols(static_cast<Index>(i) * coefficients_, coefficients_).allFinite())
        throw FitError("the fields of source " + std::to_string(chunk[i]) + " are not finite");
    const MatrixXf product = A * noise(chunk, modes_);
    worker.row_rhs += product.cast<double>();
  });
  orthonormalize(sumOfRhs());
}

/// More modes: the basis, and beside it what its modes leave of the active sources, times the weights and random
/// numbers. The next sweep finds the Y.
void FarFieldFit::grow(Index modes) {
  const Index more = modes - modes_;
  if (more <= 0) return;
  for (Worker& worker : workers_) worker.row_rhs = MatrixXd::Zero(rows_, more);
  forBlocks(active_, kChunk, [&](Worker& worker, Sources chunk) {
    read(chunk, worker);
    subtractModes(chunk, worker);
    for (std::size_t i = 0; i < chunk.size(); ++i)
      weigh(chunk[i], static_cast<Index>(i) * coefficients_, worker);
    const MatrixXf product = worker.weighted * noise(chunk, more);
    worker.row_rhs += product.cast<double>();
  });
  MatrixXd X(rows_, modes);
  X << result_.X.cast<double>(), sumOfRhs();
  modes_ = modes;
  result_.Y = MatrixXf::Zero(modes_, result_.Y.cols()).eval();
  orthonormalize(X);
}

/// X <- X R^-1 with X^T diag(area) X = R^T R; twice, since the first basis may be nearly dependent.
void FarFieldFit::orthonormalize(MatrixXd X) {
  for (int pass = 0; pass < 2; ++pass) {
    MatrixXd gram = X.transpose() * row_area_.asDiagonal() * X;
    gram.diagonal().array() += 1e-14 * gram.trace();
    const Eigen::LLT<MatrixXd> llt(gram);
    if (llt.info() != Eigen::Success || !gram.allFinite())
      throw FitError("the fit of the modes broke down: the fields are all zero");
    X = llt.matrixL().solve(X.transpose()).transpose().eval();
  }
  result_.X = X.cast<float>();
}

/// Rotates the modes so that Y's mean square is diagonal and falls.
void FarFieldFit::orderByEnergy() {
  const MatrixXf Z = whitenedY();
  const MatrixXf gram = Z * Z.transpose();
  const MatrixXf turn = eigenpairs(gram.cast<double>()).V.cast<float>();
  result_.X = (result_.X * turn).eval();
  result_.Y = (turn.transpose() * result_.Y).eval();
}

}  // namespace palpate::solver
