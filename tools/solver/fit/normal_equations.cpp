// SPDX-License-Identifier: Apache-2.0
#include "tools/solver/fit/normal_equations.h"

#include <cmath>
#include <utility>

namespace palpate::solver {

using Eigen::Index;
using Eigen::MatrixXd;

NormalEquations::NormalEquations(const MatrixXd& N, double scale, std::string who) : who_(std::move(who)) {
  if (std::isfinite(scale) && scale > 0.0 && N.diagonal().allFinite())
    for (double share = 1e-6; share < 2e-3; share *= 10.0) {
      ridge_ = share * scale;
      MatrixXd ridged = N;
      ridged.diagonal().array() += ridge_;
      llt_.compute(ridged);
      if (llt_.info() == Eigen::Success) return;
    }
  throw FitError("the fit of the modes broke down at " + who_ +
                 ": its normal equations are not positive definite, or not finite");
}

MatrixXd NormalEquations::solve(const MatrixXd& b, const MatrixXd& x0) const {
  MatrixXd x = b;
  if (x0.size() > 0) x += ridge_ * x0;
  llt_.solveInPlace(x);
  if (!x.allFinite())
    throw FitError("the fit of the modes broke down at " + who_ + ": the fields are not finite");
  return x;
}

void addPacked(const float* packed, const MatrixXd& base, MatrixXd& sum) {
  sum = base;
  for (Index j = 0; j < sum.cols(); ++j) {
    const Index below = sum.rows() - j;
    sum.col(j).tail(below) += Eigen::Map<const Eigen::VectorXf>(packed, below).cast<double>();
    packed += below;
  }
}

}  // namespace palpate::solver
