// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <stdexcept>
#include <string>

namespace palpate::solver {

/// The normal equations of a step are not positive definite, or not finite. what() names source or node.
class FitError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Solves (N + ridge I) x = b + ridge x0, so that what the equations leave open stays at x0. The ridge is a millionth of
/// `scale`; while N + ridge I is not positive definite it grows tenfold, up to a thousandth.
class NormalEquations {
 public:
  /// @param N      lower triangle
  /// @param scale  mean diagonal of N, or of what N would be with all weights 1
  /// @param who    "source 12", for the error  @throw FitError
  NormalEquations(const Eigen::MatrixXd& N, double scale, std::string who);
  /// @param b, x0  n x any; an empty x0 is zero  @throw FitError when b is not finite
  [[nodiscard]] Eigen::MatrixXd solve(const Eigen::MatrixXd& b, const Eigen::MatrixXd& x0 = {}) const;

 private:
  std::string who_;
  double ridge_{0.0};
  Eigen::LLT<Eigen::MatrixXd> llt_;
};

/// base + the symmetric matrix of a packed lower triangle (lower triangle only).
void addPacked(const float* packed, const Eigen::MatrixXd& base, Eigen::MatrixXd& sum);

}  // namespace palpate::solver
