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

/// Work on blocks of a list, by all workers, dealt out in turn: each adds up the same blocks in every run.
void FarFieldFit::forBlocks(Sources order, std::size_t block,
                            const std::function<void(Worker&, Sources)>& work) {
  parallelFor(options_.workers, workers_.size(), [&](int, std::size_t w) {
    for (std::size_t first = w * block; first < order.size(); first += workers_.size() * block)
      work(workers_[w], order.subspan(first, std::min(block, order.size() - first)));
  });
}

MatrixXd FarFieldFit::sumOfRhs() const {
  MatrixXd sum = workers_[0].row_rhs;
  for (std::size_t w = 1; w < workers_.size(); ++w) sum += workers_[w].row_rhs;
  return sum;
}

/// One sweep over the active sources. kLast and kAmplitudes skip the X-step; kAmplitudes measures no errors, and all but plain
/// sweeps those that are seen, which the next sweep's weights may follow.
void FarFieldFit::sweep(Step step) {
  for (Worker& worker : workers_) {
    worker.row_rhs = MatrixXd::Zero(rows_, modes_);
    worker.error = worker.energy = worker.seen = worker.count = 0.0;
  }
  area_X_ = row_area_.cast<float>().asDiagonal() * result_.X;
  const MatrixXf scaled = result_.X.transpose() * row_area_.cwiseSqrt().cast<float>().asDiagonal();
  area_gram_ = (scaled * scaled.transpose()).cast<double>();
  const GramSums grams(scaled, 3);
  forBlocks(active_, GramSums::blockSize(modes_, options_.workers, active_.size()),
            [&](Worker& worker, Sources block) { solveY(block, grams, step, worker); });
  double error = 0.0, energy = 0.0, seen = 0.0, count = 0.0;
  for (const Worker& worker : workers_) {
    error += worker.error;
    energy += worker.energy;
    seen += worker.seen;
    count += worker.count;
  }
  if (count > 0.0) mean_seen_ = seen / count;
  result_.errors.push_back(std::sqrt(error / std::max(energy, 1e-300)));
  if (step < Step::kLast) solveX(sumOfRhs());
}

/// Y-step: n x n normal equations per source: those of the areas, changed at nodes with another weight.
void FarFieldFit::solveY(Sources block, const GramSums& grams, Step step, Worker& worker) {
  grams.sum(
      node_order_, block, [&](std::int32_t node, std::int32_t s) { return change_(node, s); }, worker.grams);
  const double scale = area_gram_.diagonal().mean();
  MatrixXd N;
  for (std::size_t first = 0; first < block.size(); first += kChunk) {
    const Sources chunk = block.subspan(first, std::min(kChunk, block.size() - first));
    read(chunk, worker);
    const MatrixXf rhs = area_X_.transpose() * worker.weighted;
    for (std::size_t i = 0; i < chunk.size(); ++i) {
      const auto column = static_cast<Index>(i) * coefficients_;
      const MatrixXd b = rhs.middleCols(column, coefficients_).cast<double>();
      addPacked(worker.grams.sums.col(static_cast<Index>(first + i)).data(), area_gram_, N);
      columnsOf(result_.Y, chunk[i]) =
          NormalEquations(N, scale, "source " + std::to_string(chunk[i])).solve(b).cast<float>();
      addError(chunk[i], column, b, worker);
    }
    if (step == Step::kAmplitudes) continue;
    if (step != Step::kPlain) measure(chunk, step == Step::kReweighted, worker);
    if (step != Step::kLast) feedX(chunk, worker);
  }
}

/// |A - X Y|^2 in the weights, from the normal equations: |A|^2 - Y : b.
void FarFieldFit::addError(std::int32_t s, Index column, const MatrixXd& b, Worker& worker) {
  const MatrixXf W = whitening(s);
  double& energy = energies_[static_cast<std::size_t>(s)];
  if (energy < 0.0) {
    const Eigen::Map<const MatrixXf> fields(worker.fields.data(), rows_, worker.weighted.cols());
    const MatrixXf AW = fields.middleCols(column, coefficients_) * W;
    const MatrixXf weighted_AW = worker.weighted.middleCols(column, coefficients_) * W;
    energy = row_area_.dot(AW.cwiseProduct(weighted_AW).rowwise().sum().cast<double>());
  }
  const MatrixXd Wd = W.cast<double>();
  worker.energy += energy;
  worker.error +=
      std::max(0.0, energy - (columnsOf(result_.Y, s).cast<double>() * Wd).cwiseProduct(b * Wd).sum());
}

/// Right-hand side of the X-step: the weighted fields times W W^T Y^T.
void FarFieldFit::feedX(Sources chunk, Worker& worker) {
  MatrixXf V(worker.weighted.cols(), modes_);
  for (std::size_t i = 0; i < chunk.size(); ++i) {
    const MatrixXf W = whitening(chunk[i]);
    V.middleRows(static_cast<Index>(i) * coefficients_, coefficients_) =
        W * (W.transpose() * columnsOf(result_.Y, chunk[i]).transpose());
  }
  const MatrixXf product = worker.weighted * V;
  worker.row_rhs += product.cast<double>();
}

/// X-step: one n x n system per node: the sum over all sources, changed where the node's weight is not 1. The rows of Y
/// are made orthonormal first: float32 is then exact enough for the matrices. What a node's equations leave open stays
/// as it was.
void FarFieldFit::solveX(const MatrixXd& rhs) {
  MatrixXf Z = whitenedY();
  MatrixXd all = MatrixXd::Zero(modes_, modes_);
  constexpr Index kColumns = 2048;
  for (Index first = 0; first < Z.cols(); first += kColumns) {
    const MatrixXd part = Z.middleCols(first, std::min(kColumns, Z.cols() - first)).cast<double>();
    all += part * part.transpose();
  }
  const double scale = all.diagonal().mean();
  if (scale == 0.0) return;  // the near field is everything
  all.diagonal().array() += 1e-9 * scale;
  const Eigen::LLT<MatrixXd> llt(all);
  if (llt.info() != Eigen::Success || !std::isfinite(scale))
    throw FitError("the fit of the modes broke down: the fields are not finite");
  for (Index first = 0; first < Z.cols(); first += kColumns) {
    auto part = Z.middleCols(first, std::min(kColumns, Z.cols() - first));
    part = llt.matrixL().solve(part.cast<double>()).cast<float>();
  }
  const MatrixXd b = llt.matrixL().solve(rhs.transpose());
  const MatrixXd x0 = (result_.X.cast<double>() * llt.matrixL()).transpose();
  const GramSums grams(Z, coefficients_);
  const MatrixXd base = MatrixXd::Identity(modes_, modes_);
  MatrixXd X(modes_, rows_);
  forBlocks(node_order_, GramSums::blockSize(modes_, options_.workers, node_order_.size()),
            [&](Worker& worker, Sources nodes) {
              grams.sum(
                  active_, nodes, [&](std::int32_t s, std::int32_t node) { return change_(node, s); },
                  worker.grams);
              MatrixXd N;
              for (std::size_t i = 0; i < nodes.size(); ++i) {
                addPacked(worker.grams.sums.col(static_cast<Index>(i)).data(), base, N);
                X.middleCols<3>(3 * nodes[i]) =
                    NormalEquations(N, 1.0, "surface node " + std::to_string(nodes[i]))
                        .solve(b.middleCols<3>(3 * nodes[i]), x0.middleCols<3>(3 * nodes[i]));
              }
            });
  orthonormalize(X.transpose());
}

}  // namespace palpate::solver
