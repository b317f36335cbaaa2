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

void FarFieldFit::requireFinite(const Eigen::Ref<const MatrixXf>& fields, std::int32_t s) {
  if (!fields.allFinite()) throw FitError("the fields of source " + std::to_string(s) + " are not finite");
}

/// A first basis: the table times random numbers (a randomized range finder, one pass).
void FarFieldFit::sketch() {
  TreeSum<MatrixXf> sum(sources_, rows_, modes_);
  forOwn(sources_, [&](Worker& worker, std::size_t block) {
    MatrixXf part = MatrixXf::Zero(rows_, modes_);
    for (const Sources chunk : chunksOf(activeOf(block))) {
      read(chunk, worker);
      const Eigen::Map<const MatrixXf> A(worker.fields.data(), rows_, worker.weighted.cols());
      for (std::size_t i = 0; i < chunk.size(); ++i)
        requireFinite(A.middleCols(static_cast<Index>(i) * coefficients_, coefficients_), chunk[i]);
      part.noalias() += A * noise(chunk, modes_);
    }
    sum.add(block, std::move(part));
  });
  orthonormalize(sum.finish().transpose().cast<double>());
}

/// More modes: the basis, and beside it what its modes leave of the active sources, times the weights and random
/// numbers. The next sweep finds the Y.
void FarFieldFit::grow(Index modes) {
  const Index more = modes - modes_;
  if (more <= 0) return;
  TreeSum<MatrixXf> sum(sources_, rows_, more);
  forOwn(sources_, [&](Worker& worker, std::size_t block) {
    MatrixXf part = MatrixXf::Zero(rows_, more);
    for (const Sources chunk : chunksOf(activeOf(block))) {
      read(chunk, worker);
      subtractModes(chunk, worker);
      for (std::size_t i = 0; i < chunk.size(); ++i)
        weigh(chunk[i], static_cast<Index>(i) * coefficients_, worker);
      part.noalias() += worker.weighted * noise(chunk, more);
    }
    sum.add(block, std::move(part));
  });
  MatrixXd Xt(modes, rows_);
  Xt << result_.X.transpose().cast<double>(), sum.finish().transpose().cast<double>();
  modes_ = modes;
  result_.Y = MatrixXf::Zero(modes_, result_.Y.cols()).eval();
  orthonormalize(std::move(Xt));
}

/// The columns of a block of nodes side by side. @param Xt  n x 3 Ns
MatrixXd FarFieldFit::columnsOfNodes(const MatrixXd& Xt, std::size_t block) const {
  const auto nodes = nodes_.block(block);
  MatrixXd out(Xt.rows(), 3 * static_cast<Index>(nodes.size()));
  for (std::size_t i = 0; i < nodes.size(); ++i)
    out.middleCols<3>(3 * static_cast<Index>(i)) = Xt.middleCols<3>(3 * nodes[i]);
  return out;
}

/// X <- X R^-1 with X^T diag(area) X = R^T R; twice, since the first basis may be nearly dependent.
/// @param Xt  X^T, n x 3 Ns: of the nodes of this rank
void FarFieldFit::orthonormalize(MatrixXd Xt) {
  const Index n = Xt.rows();
  for (int pass = 0; pass < 2; ++pass) {
    TreeSum<MatrixXd> sum(nodes_, n, n);
    forOwn(nodes_, [&](Worker&, std::size_t block) {
      const MatrixXd own = columnsOfNodes(Xt, block);
      Eigen::VectorXd area(own.cols());
      for (Index i = 0; i < area.size(); ++i)
        area[i] = row_area_[3 * nodes_.block(block)[static_cast<std::size_t>(i / 3)]];
      sum.add(block, own * area.asDiagonal() * own.transpose());
    });
    MatrixXd gram = sum.finish();
    gram.diagonal().array() += 1e-14 * gram.trace();
    const Eigen::LLT<MatrixXd> llt(gram);
    if (llt.info() != Eigen::Success || !gram.allFinite())
      throw FitError("the fit of the modes broke down: the fields are all zero");
    forOwn(nodes_, [&](Worker&, std::size_t block) {
      const MatrixXd own = llt.matrixL().solve(columnsOfNodes(Xt, block));
      for (std::size_t i = 0; i < nodes_.block(block).size(); ++i)
        Xt.middleCols<3>(3 * nodes_.block(block)[i]) = own.middleCols<3>(3 * static_cast<Index>(i));
    });
  }
  MatrixXf all = Xt.cast<float>();
  share(nodes_, [&](std::int32_t node) {
    return std::span(all.data() + 3 * n * node, static_cast<std::size_t>(3 * n));
  });
  result_.X = all.transpose();
}

/// Rotates the modes so that Y's mean square is diagonal and falls.
void FarFieldFit::orderByEnergy() {
  const MatrixXf Z = whitenedY(active_).cast<float>();
  const MatrixXf gram = Z * Z.transpose();
  const MatrixXf turn = eigenpairs(gram.cast<double>()).V.cast<float>();
  result_.X = (result_.X * turn).eval();
  result_.Y = (turn.transpose() * result_.Y).eval();
}

}  // namespace palpate::solver
