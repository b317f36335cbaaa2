// SPDX-License-Identifier: Apache-2.0
#include "palpate/offline/far_field.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>

#include "ball_moments.h"
#include "palpate/offline/parallel.h"
#include "palpate/offline/progress.h"

namespace palpate::offline {

namespace {

using Eigen::MatrixXd;
using Eigen::MatrixXf;
using Eigen::VectorXd;

constexpr std::size_t kChunk = 32;  // positions read and multiplied at once

class Fit {
 public:
  Fit(const FitProblem& problem, const FitOptions& options);
  FarField run();

 private:
  struct Worker {
    std::vector<float> fields;
    MatrixXd row_rhs;    // 3 Ns x n, what the X-step is fed with
    double error{0.0};   // weighted square of what remains
    double energy{0.0};  // weighted square of the field
  };
  [[nodiscard]] std::size_t chunks() const { return (positions_ + kChunk - 1) / kChunk; }
  [[nodiscard]] Eigen::Map<MatrixXf> readChunk(Worker& worker, std::size_t first, std::size_t count) const;
  [[nodiscard]] MatrixXf whitening(std::size_t position) const;
  void sketch();
  void sweep(bool last);
  struct Listed {
    MatrixXf X, weighted_X, A;
    Eigen::VectorXf weight;  // change times area
  };
  [[nodiscard]] Listed listedRows(const Eigen::Ref<const MatrixXf>& A, const FitWeights& weights) const;
  void solveY(const Eigen::Map<MatrixXf>& A, std::size_t first, std::size_t count, Worker& worker);
  void feedX(const Eigen::Map<MatrixXf>& A, std::size_t first, std::size_t count, Worker& worker);
  void solveX(const MatrixXd& rhs);
  void orthonormalize(MatrixXd X);
  void orderByEnergy();

  const FitProblem& problem_;
  FitOptions options_;
  Eigen::Index rows_, coefficients_, modes_;
  std::size_t positions_;
  MatrixXd moment_factor_;  // C x C
  VectorXd row_area_;       // 3 Ns, sums to 3
  FarField result_;
  std::vector<std::vector<std::pair<std::int32_t, float>>> positions_near_;  // node -> (position, weight - 1)
  std::vector<Worker> workers_;
};

Fit::Fit(const FitProblem& problem, const FitOptions& options)
    : problem_(problem),
      options_(options),
      rows_(static_cast<Eigen::Index>(problem.table.rows())),
      coefficients_(problem.basis.size()),
      modes_(options.modes),
      positions_(problem.table.positions()),
      moment_factor_(momentFactor(problem.basis)),
      row_area_(rows_),
      workers_(static_cast<std::size_t>(std::max(1, options.workers))) {
  modes_ = std::min({modes_, rows_, static_cast<Eigen::Index>(positions_) * coefficients_});
  double total = 0.0;
  for (const double area : problem.areas) total += area;
  for (Eigen::Index row = 0; row < rows_; ++row)
    row_area_[row] = problem.areas[static_cast<std::size_t>(row / 3)] / total;
  positions_near_.resize(problem.areas.size());
  for (std::size_t s = 0; s < positions_; ++s)
    for (std::size_t j = 0; j < problem.weights[s].nodes.size(); ++j)
      positions_near_[static_cast<std::size_t>(problem.weights[s].nodes[j])].emplace_back(
          static_cast<std::int32_t>(s), problem.weights[s].change[j]);
  result_.Y = MatrixXf::Zero(modes_, static_cast<Eigen::Index>(positions_) * coefficients_);
}

/// Columns position * C + k, scaled by reference^|alpha|: metres.
Eigen::Map<MatrixXf> Fit::readChunk(Worker& worker, std::size_t first, std::size_t count) const {
  problem_.table.read(first, count, worker.fields);
  Eigen::Map<MatrixXf> A(worker.fields.data(), rows_, static_cast<Eigen::Index>(count) * coefficients_);
  for (Eigen::Index column = 0; column < A.cols(); ++column) {
    const MultiIndex& a = problem_.basis[static_cast<int>(column % coefficients_)];
    A.col(column) *= static_cast<float>(std::pow(problem_.reference, a[0] + a[1] + a[2]));
  }
  return A;
}

/// C x C: times this, the columns of one position are orthonormal in the mean over its ball,
/// relative to |d| (or to the size of its displacements times |f| / f_ref).
MatrixXf Fit::whitening(std::size_t position) const {
  const double travel = problem_.ball_radius[position] / problem_.reference;
  const double size = problem_.size.empty() ? problem_.reference : problem_.size[position];
  MatrixXd D = moment_factor_;
  for (Eigen::Index k = 0; k < coefficients_; ++k) {
    const MultiIndex& a = problem_.basis[static_cast<int>(k)];
    D.row(k) *= std::pow(std::max(travel, 1e-3), a[0] + a[1] + a[2] - 1) / size;
  }
  return D.cast<float>();
}

/// A first basis: the range of the table met by random numbers (a randomized range finder, one pass).
void Fit::sketch() {
  for (Worker& worker : workers_) worker.row_rhs = MatrixXd::Zero(rows_, modes_);
  parallelFor(options_.workers, chunks(), [&](int w, std::size_t chunk) {
    Worker& worker = workers_[static_cast<std::size_t>(w)];
    const std::size_t first = chunk * kChunk;
    const std::size_t count = std::min(kChunk, positions_ - first);
    const Eigen::Map<MatrixXf> A = readChunk(worker, first, count);
    std::mt19937 random(static_cast<std::mt19937::result_type>(chunk));
    std::normal_distribution<float> normal;
    for (std::size_t i = 0; i < count; ++i) {
      const MatrixXf noise = MatrixXf::NullaryExpr(coefficients_, modes_, [&] { return normal(random); });
      const Eigen::Index column = static_cast<Eigen::Index>(i) * coefficients_;
      worker.row_rhs += (A.middleCols(column, coefficients_) * (whitening(first + i) * noise)).cast<double>();
    }
  });
  MatrixXd X = workers_[0].row_rhs;
  for (std::size_t w = 1; w < workers_.size(); ++w) X += workers_[w].row_rhs;
  orthonormalize(X);
}

/// X <- X R^-1 with X^T diag(area) X = R^T R; twice, since the first basis may be nearly dependent.
void Fit::orthonormalize(MatrixXd X) {
  for (int pass = 0; pass < 2; ++pass) {
    MatrixXd gram = X.transpose() * row_area_.asDiagonal() * X;
    gram.diagonal().array() += 1e-14 * gram.trace();
    const Eigen::LLT<MatrixXd> llt(gram);
    X = llt.matrixL().solve(X.transpose()).transpose().eval();
  }
  if (!X.allFinite()) throw std::runtime_error("the fit of the modes broke down: the fields are not finite");
  result_.X = X.cast<float>();
}

/// Y-step: n x n normal equations a position, those of the areas changed at the nodes that count otherwise.
void Fit::solveY(const Eigen::Map<MatrixXf>& A, std::size_t first, std::size_t count, Worker& worker) {
  const MatrixXf weighted = row_area_.cast<float>().asDiagonal() * result_.X;
  const MatrixXf rhs = weighted.transpose() * A;
  const MatrixXd gram = (weighted.transpose() * result_.X).cast<double>();
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::Index column = static_cast<Eigen::Index>(i) * coefficients_;
    const Listed listed = listedRows(A.middleCols(column, coefficients_), problem_.weights[first + i]);
    const MatrixXf near_gram = listed.X.transpose() * listed.weighted_X;
    MatrixXd normal = gram + near_gram.cast<double>();
    normal.diagonal().array() += 1e-6;  // X is orthonormal: against what only free entries would see
    const MatrixXf near_rhs = listed.weighted_X.transpose() * listed.A;
    const MatrixXd b = (rhs.middleCols(column, coefficients_) + near_rhs).cast<double>();
    const MatrixXd Y = normal.llt().solve(b);
    result_.Y.middleCols(static_cast<Eigen::Index>(first) * coefficients_ + column, coefficients_) =
        Y.cast<float>();
    // |A - X Y|^2 in the weights, from the normal equations: |A|^2 - Y : b.
    const MatrixXf W = whitening(first + i);
    const MatrixXf AW =
        row_area_.cast<float>().cwiseSqrt().asDiagonal() * (A.middleCols(column, coefficients_) * W);
    const MatrixXf AnW = listed.A * W;
    const MatrixXf changed = listed.weight.asDiagonal() * AnW;
    const double energy = AW.cast<double>().squaredNorm() + changed.cwiseProduct(AnW).cast<double>().sum();
    const MatrixXd Wd = W.cast<double>();
    worker.energy += energy;
    worker.error += std::max(0.0, energy - (Y * Wd).cwiseProduct(b * Wd).sum());
  }
}

/// The rows of the nodes that count otherwise than by their area.
Fit::Listed Fit::listedRows(const Eigen::Ref<const MatrixXf>& A, const FitWeights& weights) const {
  const auto K = static_cast<Eigen::Index>(weights.nodes.size());
  Listed listed{MatrixXf(3 * K, modes_), MatrixXf(), MatrixXf(3 * K, coefficients_), Eigen::VectorXf(3 * K)};
  for (Eigen::Index j = 0; j < K; ++j) {
    const Eigen::Index row = 3 * weights.nodes[static_cast<std::size_t>(j)];
    listed.X.middleRows<3>(3 * j) = result_.X.middleRows<3>(row);
    listed.A.middleRows<3>(3 * j) = A.middleRows<3>(row);
    listed.weight.segment<3>(3 * j).setConstant(weights.change[static_cast<std::size_t>(j)] *
                                                static_cast<float>(row_area_[row]));
  }
  listed.weighted_X = listed.weight.asDiagonal() * listed.X;
  return listed;
}

/// Right-hand side of the X-step: A W W^T Y^T, changed at the nodes that count otherwise.
void Fit::feedX(const Eigen::Map<MatrixXf>& A, std::size_t first, std::size_t count, Worker& worker) {
  MatrixXf V(A.cols(), modes_);
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::Index column = static_cast<Eigen::Index>(i) * coefficients_;
    const MatrixXf W = whitening(first + i);
    const auto Y =
        result_.Y.middleCols(static_cast<Eigen::Index>(first) * coefficients_ + column, coefficients_);
    V.middleRows(column, coefficients_) = W * (W.transpose() * Y.transpose());
    const FitWeights& weights = problem_.weights[first + i];
    MatrixXf An(static_cast<Eigen::Index>(3 * weights.nodes.size()), coefficients_);
    for (std::size_t j = 0; j < weights.nodes.size(); ++j)
      An.middleRows<3>(static_cast<Eigen::Index>(3 * j)) =
          weights.change[j] * A.block(3 * weights.nodes[j], column, 3, coefficients_);
    const MatrixXf near_part = An * V.middleRows(column, coefficients_);
    for (std::size_t j = 0; j < weights.nodes.size(); ++j)
      worker.row_rhs.middleRows<3>(3 * weights.nodes[j]) +=
          near_part.middleRows<3>(static_cast<Eigen::Index>(3 * j)).cast<double>();
  }
  const MatrixXf product = A * V;
  worker.row_rhs += product.cast<double>();
}

/// X-step: one n x n system a node, that of all positions changed where the node counts otherwise.
void Fit::solveX(const MatrixXd& rhs) {
  MatrixXf Z(result_.Y.rows(), result_.Y.cols());
  for (std::size_t s = 0; s < positions_; ++s) {
    const Eigen::Index column = static_cast<Eigen::Index>(s) * coefficients_;
    Z.middleCols(column, coefficients_) = result_.Y.middleCols(column, coefficients_) * whitening(s);
  }
  const MatrixXf all_f = Z * Z.transpose();
  const MatrixXd all = all_f.cast<double>();
  const double ridge = 1e-9 * all.trace() / static_cast<double>(modes_);
  MatrixXd X(rows_, modes_);
  parallelFor(options_.workers, problem_.areas.size(), [&](int, std::size_t node) {
    const auto& near = positions_near_[node];
    MatrixXf Zn(modes_, static_cast<Eigen::Index>(near.size()) * coefficients_);
    MatrixXf weighted(Zn.rows(), Zn.cols());
    for (std::size_t j = 0; j < near.size(); ++j) {
      const auto column = static_cast<Eigen::Index>(j) * coefficients_;
      Zn.middleCols(column, coefficients_) = Z.middleCols(near[j].first * coefficients_, coefficients_);
      weighted.middleCols(column, coefficients_) = near[j].second * Zn.middleCols(column, coefficients_);
    }
    const MatrixXf change = weighted * Zn.transpose();
    MatrixXd normal = all + change.cast<double>();
    normal.diagonal().array() += ridge;
    const auto row = static_cast<Eigen::Index>(3 * node);
    X.middleRows<3>(row) = normal.llt().solve(rhs.middleRows<3>(row).transpose()).transpose();
  });
  orthonormalize(X);
}

void Fit::sweep(bool last) {
  for (Worker& worker : workers_) {
    worker.row_rhs = MatrixXd::Zero(rows_, modes_);
    worker.error = worker.energy = 0.0;
  }
  parallelFor(options_.workers, chunks(), [&](int w, std::size_t chunk) {
    Worker& worker = workers_[static_cast<std::size_t>(w)];
    const std::size_t first = chunk * kChunk;
    const std::size_t count = std::min(kChunk, positions_ - first);
    const Eigen::Map<MatrixXf> A = readChunk(worker, first, count);
    solveY(A, first, count, worker);
    if (!last) feedX(A, first, count, worker);
  });
  double error = 0.0, energy = 0.0;
  for (const Worker& worker : workers_) {
    error += worker.error;
    energy += worker.energy;
  }
  result_.errors.push_back(std::sqrt(error / std::max(energy, 1e-300)));
  if (last) return;
  MatrixXd rhs = workers_[0].row_rhs;
  for (std::size_t w = 1; w < workers_.size(); ++w) rhs += workers_[w].row_rhs;
  solveX(rhs);
}

/// Turns the modes so that Y's mean square is diagonal and falls.
void Fit::orderByEnergy() {
  MatrixXf Z(result_.Y.rows(), result_.Y.cols());
  for (std::size_t s = 0; s < positions_; ++s) {
    const Eigen::Index column = static_cast<Eigen::Index>(s) * coefficients_;
    Z.middleCols(column, coefficients_) = result_.Y.middleCols(column, coefficients_) * whitening(s);
  }
  const MatrixXf gram = Z * Z.transpose();
  const Eigen::SelfAdjointEigenSolver<MatrixXd> eigen(gram.cast<double>());
  const MatrixXf turn = eigen.eigenvectors().rowwise().reverse().cast<float>();
  result_.X = (result_.X * turn).eval();
  result_.Y = (turn.transpose() * result_.Y).eval();
}

FarField Fit::run() {
  Progress progress("far field", static_cast<std::size_t>(options_.sweeps) + 2, options_.quiet);
  sketch();
  progress.advance();
  for (int i = 0; i < options_.sweeps; ++i) {
    sweep(false);
    progress.advance();
  }
  sweep(true);
  orderByEnergy();
  progress.advance();
  return std::move(result_);
}

}  // namespace

FarField fitFarField(const FitProblem& problem, const FitOptions& options) {
  if (problem.table.positions() == 0 || options.modes < 1)
    throw std::runtime_error("nothing to fit: no contact positions or no modes");
  return Fit(problem, options).run();
}

}  // namespace palpate::offline
