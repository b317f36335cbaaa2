// SPDX-License-Identifier: Apache-2.0
#include "tools/solver/pgd/residual_estimate.h"

#include <algorithm>
#include <cmath>
#include <random>

namespace palpate::solver {

using Eigen::MatrixXd;

ResidualEstimate::ResidualEstimate(const SparseMatrix& K, const SeparatedLoad& load,
                                   const Eigen::VectorXd& weights, int probes, unsigned seed,
                                   const std::function<MatrixXd(const MatrixXd&)>& solve)
    : K_(K) {
  std::mt19937 random(seed * 104729U + 1U);
  std::normal_distribution<double> normal;
  const MatrixXd z = MatrixXd::NullaryExpr(weights.size(), probes, [&] { return normal(random); });
  P_ = weights.cwiseSqrt().asDiagonal() * z;
  V_ = solve(load.times(P_));
}

ResidualEstimate::Result ResidualEstimate::operator()(const SeparatedSolution& u, double captured) const {
  const MatrixXd e = u.pairs() > 0 ? MatrixXd(V_ - u.times(P_)) : V_;
  const Eigen::ArrayXd squares = e.cwiseProduct(K_ * e).colwise().sum().transpose().array();
  const auto probes = static_cast<double>(squares.size());
  const double mean = squares.mean();
  const double deviation = std::sqrt((squares - mean).square().sum() / (probes - 1.0) / probes);
  const double all = std::max(mean + captured, 1e-300);
  Result result;
  result.relative = std::sqrt(mean / all);
  // The square's derivative with respect to the mean is captured / all^2.
  if (mean > 0.0) result.spread = 0.5 * deviation * std::max(0.0, captured) / (all * all) / result.relative;
  return result;
}

}  // namespace palpate::solver
