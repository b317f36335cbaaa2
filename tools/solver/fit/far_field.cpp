// SPDX-License-Identifier: Apache-2.0
#include "tools/solver/fit/far_field.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <random>

#include "tools/solver/base/dense_decompositions.h"
#include "tools/solver/base/progress.h"
#include "tools/solver/fit/ball_moments.h"
#include "tools/solver/fit/far_field_fit.h"
#include "tools/solver/fit/normal_equations.h"
#include "tools/solver/fit/spatial_order.h"

namespace palpate::solver {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::MatrixXf;

FarFieldFit::FarFieldFit(const FitProblem& problem, const FitOptions& options)
    : problem_(problem),
      options_(options),
      rows_(static_cast<Index>(problem.table.rows())),
      coefficients_(problem.basis.size()),
      modes_(options.modes),
      moment_factor_(momentFactor(problem.basis)),
      row_area_(rows_),
      node_order_(spatialOrder(problem.places)),
      energies_(problem.sources.size(), -1.0),
      workers_(static_cast<std::size_t>(std::max(1, options.workers))) {
  const Index columns = static_cast<Index>(problem.sources.size()) * coefficients_;
  modes_ = std::min({modes_, rows_, columns});
  double total = 0.0;
  for (const double area : problem.areas) total += area;
  for (Index row = 0; row < rows_; ++row)
    row_area_[row] = problem.areas[static_cast<std::size_t>(row / 3)] / total;
  std::vector<Vec3> places;
  for (const FitSource& one : problem.sources) places.push_back(one.place);
  source_order_ = spatialOrder(places);
  collectNeighbours();
  result_.Y = MatrixXf::Zero(modes_, columns);
}

/// The weights by node.
void FarFieldFit::collectNeighbours() {
  neighbours_.assign(problem_.areas.size(), {});
  for (std::size_t s = 0; s < problem_.sources.size(); ++s) {
    const FitWeights& weights = problem_.sources[s].weights;
    for (std::size_t j = 0; j < weights.nodes.size(); ++j) {
      Neighbours& near = neighbours_[static_cast<std::size_t>(weights.nodes[j])];
      near.sources.push_back(static_cast<std::int32_t>(s));
      near.change.push_back(weights.change[j]);
    }
  }
}

/// The fields of some sources, columns i * C + k, scaled by reference^|alpha|: metres; and the same times the weights.
void FarFieldFit::read(Sources chunk, Worker& worker) const {
  const auto block = static_cast<std::size_t>(rows_ * coefficients_);
  worker.fields.resize(chunk.size() * block);
  worker.weighted.resize(rows_, static_cast<Index>(chunk.size()) * coefficients_);
  Eigen::VectorXf weight(rows_);
  for (std::size_t i = 0; i < chunk.size(); ++i) {
    float* const own = worker.fields.data() + i * block;
    problem_.table.read(static_cast<std::size_t>(chunk[i]), std::span(own, block));
    Eigen::Map<MatrixXf> A(own, rows_, coefficients_);
    weight.setOnes();
    const FitWeights& weights = source(chunk[i]).weights;
    for (std::size_t j = 0; j < weights.nodes.size(); ++j)
      weight.segment<3>(3 * weights.nodes[j]).array() += weights.change[j];
    for (Index k = 0; k < coefficients_; ++k) {
      const MultiIndex& a = problem_.basis[static_cast<int>(k)];
      A.col(k) *= static_cast<float>(std::pow(problem_.reference, a[0] + a[1] + a[2]));
      worker.weighted.col(static_cast<Index>(i) * coefficients_ + k) = A.col(k).cwiseProduct(weight);
    }
  }
}

/// C x C: times this, the columns of one source are orthonormal in the mean over its ball,
/// relative to |d| (or to the size of its displacements times |f| / f_ref).
MatrixXf FarFieldFit::whitening(std::int32_t s) const {
  const double travel = source(s).ball_radius / problem_.reference;
  MatrixXd D = moment_factor_;
  for (Index k = 0; k < coefficients_; ++k) {
    const MultiIndex& a = problem_.basis[static_cast<int>(k)];
    D.row(k) *= std::pow(std::max(travel, 1e-3), a[0] + a[1] + a[2] - 1) / source(s).size;
  }
  return D.cast<float>();
}

/// The Y of all sources, each times its whitening.
MatrixXf FarFieldFit::whitenedY() {
  MatrixXf Z(result_.Y.rows(), result_.Y.cols());
  for (const std::int32_t s : source_order_) columnsOf(Z, s) = columnsOf(result_.Y, s) * whitening(s);
  return Z;
}

/// A first basis: the table times random numbers (a randomized range finder, one pass).
void FarFieldFit::sketch() {
  for (Worker& worker : workers_) worker.row_rhs = MatrixXd::Zero(rows_, modes_);
  forBlocks(source_order_, kChunk, [&](Worker& worker, Sources chunk) {
    read(chunk, worker);
    const Eigen::Map<const MatrixXf> A(worker.fields.data(), rows_, worker.weighted.cols());
    MatrixXf noise(worker.weighted.cols(), modes_);
    for (std::size_t i = 0; i < chunk.size(); ++i) {
      if (!A.middleCols(static_cast<Index>(i) * coefficients_, coefficients_).allFinite())
        throw FitError("the fields of source " + std::to_string(chunk[i]) + " are not finite");
      std::mt19937 random(static_cast<std::mt19937::result_type>(chunk[i]));
      std::normal_distribution<float> normal;
      noise.middleRows(static_cast<Index>(i) * coefficients_, coefficients_) =
          whitening(chunk[i]) * MatrixXf::NullaryExpr(coefficients_, modes_, [&] { return normal(random); });
    }
    const MatrixXf product = A * noise;
    worker.row_rhs += product.cast<double>();
  });
  orthonormalize(sumOfRhs());
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
  if (problem.sources.empty() || options.modes < 1)
    throw FitError("nothing to fit: no contact positions or no modes");
  return FarFieldFit(problem, options).run();
}

}  // namespace palpate::solver
