// SPDX-License-Identifier: Apache-2.0
#include "tools/solver/fit/far_field.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>

#include "tools/solver/base/dense_decompositions.h"
#include "tools/solver/base/parallel.h"
#include "tools/solver/base/progress.h"
#include "tools/solver/fit/ball_moments.h"
#include "tools/solver/fit/far_field_fit.h"

namespace palpate::solver {

using Eigen::MatrixXd;
using Eigen::MatrixXf;

FarFieldFit::FarFieldFit(const FitProblem& problem, const FitOptions& options)
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
Eigen::Map<MatrixXf> FarFieldFit::readChunk(Worker& worker, std::size_t first, std::size_t count) const {
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
MatrixXf FarFieldFit::whitening(std::size_t position) const {
  const double travel = problem_.ball_radius[position] / problem_.reference;
  const double size = problem_.size.empty() ? problem_.reference : problem_.size[position];
  MatrixXd D = moment_factor_;
  for (Eigen::Index k = 0; k < coefficients_; ++k) {
    const MultiIndex& a = problem_.basis[static_cast<int>(k)];
    D.row(k) *= std::pow(std::max(travel, 1e-3), a[0] + a[1] + a[2] - 1) / size;
  }
  return D.cast<float>();
}

/// The Y of all positions, each times its whitening.
MatrixXf FarFieldFit::whitenedY() const {
  MatrixXf Z(result_.Y.rows(), result_.Y.cols());
  for (std::size_t s = 0; s < positions_; ++s) {
    const Eigen::Index column = static_cast<Eigen::Index>(s) * coefficients_;
    Z.middleCols(column, coefficients_) = result_.Y.middleCols(column, coefficients_) * whitening(s);
  }
  return Z;
}

/// A first basis: the table times random numbers (a randomized range finder, one pass).
void FarFieldFit::sketch() {
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
void FarFieldFit::orthonormalize(MatrixXd X) {
  for (int pass = 0; pass < 2; ++pass) {
    MatrixXd gram = X.transpose() * row_area_.asDiagonal() * X;
    gram.diagonal().array() += 1e-14 * gram.trace();
    const Eigen::LLT<MatrixXd> llt(gram);
    X = llt.matrixL().solve(X.transpose()).transpose().eval();
  }
  if (!X.allFinite()) throw std::runtime_error("the fit of the modes broke down: the fields are not finite");
  result_.X = X.cast<float>();
}

void FarFieldFit::sweep(bool last) {
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

/// Rotates the modes so that Y's mean square is diagonal and falls.
void FarFieldFit::orderByEnergy() {
  const MatrixXf Z = whitenedY();
  const MatrixXf gram = Z * Z.transpose();
  const MatrixXf turn = eigenpairs(gram.cast<double>()).V.cast<float>();
  result_.X = (result_.X * turn).eval();
  result_.Y = (turn.transpose() * result_.Y).eval();
}

FarField FarFieldFit::run() {
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

FarField fitFarField(const FitProblem& problem, const FitOptions& options) {
  if (problem.table.positions() == 0 || options.modes < 1)
    throw std::runtime_error("nothing to fit: no contact positions or no modes");
  return FarFieldFit(problem, options).run();
}

}  // namespace palpate::solver
