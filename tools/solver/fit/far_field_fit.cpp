// SPDX-License-Identifier: Apache-2.0
// The two steps of a sweep: least squares in Y for given X, and in X for given Y.       docs/design.md, Parts
#include "tools/solver/fit/far_field_fit.h"

#include <Eigen/Cholesky>
#include <algorithm>

#include "tools/solver/base/parallel.h"
#include "tools/solver/fit/normal_equations.h"

namespace palpate::solver {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::MatrixXf;

/// Work on this rank's blocks by all workers.
void FarFieldFit::forOwn(const Blocks& blocks, const std::function<void(Worker&, std::size_t)>& work) {
  const int rank = blocks.ranks().rank();
  const std::size_t first = blocks.firstOf(rank);
  parallelFor(options_.workers, blocks.firstOf(rank + 1) - first,
              [&](int w, std::size_t i) { work(workers_[static_cast<std::size_t>(w)], first + i); });
}

std::vector<FarFieldFit::Sources> FarFieldFit::chunksOf(Sources sources) {
  std::vector<Sources> chunks;
  for (std::size_t first = 0; first < sources.size(); first += kChunk)
    chunks.push_back(sources.subspan(first, std::min(kChunk, sources.size() - first)));
  return chunks;
}

/// One sweep over the active sources. kLast and kAmplitudes skip the X-step; kAmplitudes measures no errors, and all but plain
/// sweeps those that are seen, which the next sweep's weights may follow.
void FarFieldFit::sweep(Step step) {
  area_X_ = row_area_.cast<float>().asDiagonal() * result_.X;
  const MatrixXf scaled = result_.X.transpose() * row_area_.cwiseSqrt().cast<float>().asDiagonal();
  area_gram_ = (scaled * scaled.transpose()).cast<double>();
  const GramSums grams(scaled, 3);
  TreeSum<MatrixXf> rhs(sources_, rows_, modes_);
  forOwn(sources_, [&](Worker& worker, std::size_t block) {
    MatrixXf part;
    if (step < Step::kLast) part.setZero(rows_, modes_);
    solveY(activeOf(block), grams, step, worker, part);
    if (step < Step::kLast) rhs.add(block, std::move(part));
  });
  if (step == Step::kAmplitudes) return;
  addUpErrors();
  if (step == Step::kReweighted)
    share(sources_, [&](std::int32_t s) {
      return std::span(change_.col(s).data(), static_cast<std::size_t>(change_.rows()));
    });
  if (step < Step::kLast) solveX(rhs.finish());
}

/// Of all ranks, in the order of the sources.
void FarFieldFit::addUpErrors() {
  share(sources_, [&](std::int32_t s) { return std::span(&errors_[static_cast<std::size_t>(s)], 1); });
  Errors sum;
  for (const std::int32_t s : active_) {
    const Errors& own = errors_[static_cast<std::size_t>(s)];
    sum.error += own.error;
    sum.energy += own.energy;
    sum.seen += own.seen;
    sum.count += own.count;
    result_.largest[static_cast<std::size_t>(s)] = static_cast<float>(own.largest);
  }
  if (sum.count > 0.0) mean_seen_ = sum.seen / sum.count;
  result_.errors.push_back(std::sqrt(sum.error / std::max(sum.energy, 1e-300)));
}

/// Y-step: n x n normal equations per source: those of the areas, changed at nodes with another weight.
void FarFieldFit::solveY(Sources block, const GramSums& grams, Step step, Worker& worker, MatrixXf& x_rhs) {
  grams.sum(
      nodes_.order(), block, [&](std::int32_t node, std::int32_t s) { return change_(node, s); },
      worker.grams);
  const double scale = area_gram_.diagonal().mean();
  MatrixXd N;
  Index matrix = 0;
  for (const Sources chunk : chunksOf(block)) {
    read(chunk, worker);
    const MatrixXf rhs = area_X_.transpose() * worker.weighted;
    for (std::size_t i = 0; i < chunk.size(); ++i) {
      const auto column = static_cast<Index>(i) * coefficients_;
      const MatrixXd b = rhs.middleCols(column, coefficients_).cast<double>();
      addPacked(worker.grams.sums.col(matrix++).data(), area_gram_, N);
      columnsOf(result_.Y, chunk[i]) =
          NormalEquations(N, scale, "source " + std::to_string(chunk[i])).solve(b).cast<float>();
      errors_[static_cast<std::size_t>(chunk[i])] = {};
      addError(chunk[i], column, b, worker);
    }
    if (step == Step::kAmplitudes) continue;
    if (step != Step::kPlain) measure(chunk, step == Step::kReweighted, worker);
    if (step != Step::kLast) feedX(chunk, worker, x_rhs);
  }
}

/// |A - X Y|^2 in the weights, from the normal equations: |A|^2 - Y : b.
void FarFieldFit::addError(std::int32_t s, Index column, const MatrixXd& b, const Worker& worker) {
  const MatrixXf W = whitening(s);
  double& energy = energies_[static_cast<std::size_t>(s)];
  if (energy < 0.0) {
    const Eigen::Map<const MatrixXf> fields(worker.fields.data(), rows_, worker.weighted.cols());
    const MatrixXf AW = fields.middleCols(column, coefficients_) * W;
    const MatrixXf weighted_AW = worker.weighted.middleCols(column, coefficients_) * W;
    energy = row_area_.dot(AW.cwiseProduct(weighted_AW).rowwise().sum().cast<double>());
  }
  const MatrixXd Wd = W.cast<double>();
  Errors& own = errors_[static_cast<std::size_t>(s)];
  own.energy = energy;
  own.error =
      std::max(0.0, energy - (columnsOf(result_.Y, s).cast<double>() * Wd).cwiseProduct(b * Wd).sum());
}

/// Adds to the right-hand side of the X-step: the weighted fields times W W^T Y^T.
void FarFieldFit::feedX(Sources chunk, const Worker& worker, MatrixXf& rhs) {
  MatrixXf V(worker.weighted.cols(), modes_);
  for (std::size_t i = 0; i < chunk.size(); ++i) {
    const MatrixXf W = whitening(chunk[i]);
    V.middleRows(static_cast<Index>(i) * coefficients_, coefficients_) =
        W * (W.transpose() * columnsOf(result_.Y, chunk[i]).transpose());
  }
  rhs.noalias() += worker.weighted * V;
}

/// The whitened Y of all active sources, its rows made orthonormal, on all ranks; 0 for the other sources.
/// @param[out] llt  of what its rows were  @return false where there is nothing
bool FarFieldFit::whitenAll(MatrixXf& Z, Eigen::LLT<MatrixXd>& llt) {
  TreeSum<MatrixXd> sum(sources_, modes_, modes_);
  forOwn(sources_, [&](Worker&, std::size_t block) {
    const MatrixXd own = whitenedY(activeOf(block));
    MatrixXd gram = MatrixXd::Zero(modes_, modes_);
    gram.selfadjointView<Eigen::Lower>().rankUpdate(own);
    sum.add(block, std::move(gram));
  });
  MatrixXd all = sum.finish();
  const double scale = all.diagonal().mean();
  if (scale == 0.0) return false;
  all.diagonal().array() += 1e-9 * scale;
  llt.compute(all);
  if (llt.info() != Eigen::Success || !std::isfinite(scale))
    throw FitError("the fit of the modes broke down: the fields are not finite");
  Z.setZero(modes_, result_.Y.cols());
  forOwn(sources_, [&](Worker&, std::size_t block) {
    const Sources active = activeOf(block);
    const MatrixXd own = llt.matrixL().solve(whitenedY(active));
    for (std::size_t i = 0; i < active.size(); ++i)
      columnsOf(Z, active[i]) =
          own.middleCols(static_cast<Index>(i) * coefficients_, coefficients_).cast<float>();
  });
  const auto size = static_cast<std::size_t>(modes_ * coefficients_);
  share(sources_,
        [&](std::int32_t s) { return std::span(Z.data() + static_cast<std::size_t>(s) * size, size); });
  return true;
}

/// X-step: one n x n system per node: the sum over all sources, changed where the node's weight is not 1. The rows of Y
/// are made orthonormal first: float32 is then exact enough for the matrices. What a node's equations leave open stays
/// as it was.
void FarFieldFit::solveX(const MatrixXf& rhs) {
  MatrixXf Z;
  Eigen::LLT<MatrixXd> llt;
  if (!whitenAll(Z, llt)) return;  // the near field is everything
  const GramSums grams(Z, coefficients_);
  const MatrixXd base = MatrixXd::Identity(modes_, modes_);
  MatrixXd Xt(modes_, rows_);
  forOwn(nodes_, [&](Worker& worker, std::size_t block) {
    const auto nodes = nodes_.block(block);
    grams.sum(
        active_, nodes, [&](std::int32_t s, std::int32_t node) { return change_(node, s); }, worker.grams);
    MatrixXd b(modes_, 3 * static_cast<Index>(nodes.size())), x0(b.rows(), b.cols());
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      b.middleCols<3>(3 * static_cast<Index>(i)) = rhs.middleRows<3>(3 * nodes[i]).transpose().cast<double>();
      x0.middleCols<3>(3 * static_cast<Index>(i)) =
          result_.X.middleRows<3>(3 * nodes[i]).transpose().cast<double>();
    }
    llt.matrixL().solveInPlace(b);
    x0 = (llt.matrixU() * x0).eval();
    MatrixXd N;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      const auto column = 3 * static_cast<Index>(i);
      addPacked(worker.grams.sums.col(static_cast<Index>(i)).data(), base, N);
      Xt.middleCols<3>(3 * nodes[i]) = NormalEquations(N, 1.0, "surface node " + std::to_string(nodes[i]))
                                           .solve(b.middleCols<3>(column), x0.middleCols<3>(column));
    }
  });
  orthonormalize(std::move(Xt));
}

}  // namespace palpate::solver
