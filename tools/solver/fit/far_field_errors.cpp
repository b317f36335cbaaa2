// SPDX-License-Identifier: Apache-2.0
// The error that a user sees, the largest of any node, and weights that follow it.       docs/design.md, Parts
#include <algorithm>
#include <cmath>

#include "tools/solver/fit/far_field_fit.h"

namespace palpate::solver {

using Eigen::Index;
using Eigen::MatrixXf;
using Eigen::VectorXf;

/// coefficients_ x 26: the columns of one source times this are its fields over abs(d), abs(d) the ball's radius.
MatrixXf FarFieldFit::directions(std::int32_t s) const {
  const double travel = std::max(source(s).ball_radius / problem_.reference, 1e-3);
  const Index C = problem_.basis.size();
  MatrixXf D(C, 26);
  for (Index q = 0, cell = 0; cell < 27; ++cell) {
    if (cell == 13) continue;  // no direction
    const Vec3 x = Vec3(static_cast<double>(cell / 9 - 1), static_cast<double>(cell / 3 % 3 - 1),
                        static_cast<double>(cell % 3 - 1))
                       .normalized();
    for (Index k = 0; k < C; ++k) {
      const MultiIndex& a = problem_.basis[static_cast<int>(k)];
      D(k, q) = static_cast<float>(std::pow(x.x(), a[0]) * std::pow(x.y(), a[1]) * std::pow(x.z(), a[2]) *
                                   std::pow(travel, a[0] + a[1] + a[2] - 1) / source(s).size);
    }
    ++q;
  }
  if (!over_all_) D = principal_of_.middleCols(s * C, C) * D;
  return D;
}

/// Worker::fields <- fields - modes.
void FarFieldFit::subtractModes(Sources chunk, Worker& worker) {
  MatrixXf Y(modes_, static_cast<Index>(chunk.size()) * coefficients_);
  for (std::size_t i = 0; i < chunk.size(); ++i)
    Y.middleCols(static_cast<Index>(i) * coefficients_, coefficients_) = columnsOf(result_.Y, chunk[i]);
  Eigen::Map<MatrixXf>(worker.fields.data(), rows_, Y.cols()).noalias() -= result_.X * Y;
}

/// The errors of a chunk whose Y is known. @param reweight  also moves its weights
void FarFieldFit::measure(Sources chunk, bool reweight, Worker& worker) {
  subtractModes(chunk, worker);
  const Eigen::Map<const MatrixXf> rest(worker.fields.data(), rows_, worker.weighted.cols());
  MatrixXf shown(rows_, 26);
  VectorXf errors(rows_ / 3);
  for (std::size_t i = 0; i < chunk.size(); ++i) {
    const auto column = static_cast<Index>(i) * coefficients_;
    shown.noalias() = rest.middleCols(column, coefficients_) * directions(chunk[i]);
    errors.setZero();
    for (Index q = 0; q < shown.cols(); ++q)
      errors = errors.cwiseMax(Eigen::Map<const Eigen::Matrix3Xf>(shown.col(q).data(), 3, errors.size())
                                   .colwise()
                                   .squaredNorm()
                                   .transpose());
    errors = errors.cwiseSqrt();
    const FitWeights& weights = source(chunk[i]).weights;
    Errors& own = errors_[static_cast<std::size_t>(chunk[i])];
    own.count += static_cast<double>(errors.size());
    for (std::size_t j = 0; j < weights.nodes.size(); ++j) {
      errors[weights.nodes[j]] *= weights.shown[j];
      if (weights.shown[j] <= 0.0F) own.count -= 1.0;
    }
    own.seen = errors.cast<double>().sum();
    own.largest = double{errors.maxCoeff()};
    if (reweight && mean_seen_ > 0.0) moveWeights(chunk[i], errors, column, worker);
  }
}

/// Each weight times clamp(0.5 + 1.5 e / mean e, 0, 4), e its error: towards the least largest error.
/// After C. L. Lawson, Contributions to the Theory of Linear Least Maximum Approximation, UCLA 1961; he multiplies by e
/// itself, which many sweeps need to settle.
void FarFieldFit::moveWeights(std::int32_t s, const VectorXf& errors, Index column, Worker& worker) {
  const VectorXf factors =
      (0.5F + 1.5F / static_cast<float>(mean_seen_) * errors.array()).cwiseMin(4.0F).matrix();
  change_.col(s) = (change_.col(s).array() + 1.0F) * factors.array() - 1.0F;
  auto weighted = worker.weighted.middleCols(column, coefficients_);
  weighted.array().colwise() *= factors.transpose().replicate<3, 1>().reshaped().array();
  energies_[static_cast<std::size_t>(s)] = -1.0;
}

}  // namespace palpate::solver
