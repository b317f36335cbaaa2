// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "tools/solver/fem/cholesky.h"
#include "tools/solver/pgd/load_stepping.h"
#include "tools/solver/pgd/parametric_problem.h"
#include "tools/solver/pgd/tangent_table.h"

namespace palpate::solver {

using RowMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// The increment of one load step for all positions, D_s = X y_s, and the X that all steps share: Galerkin in
/// X, and new pairs by alternating directions. See solveExplicit().
class SeparatedIncrement {
 public:
  SeparatedIncrement(const ParametricProblem& problem, const ExplicitOptions& options);

  /// Linearizes about u_s = X y_s at load level `from` and solves in the present X. @param to  next level
  void begin(double from, double to);
  /// Relative norm of rho, see ExplicitOptions::tolerance.
  [[nodiscard]] double residual() const;
  /// Adds a pair. @return false when X already holds the residual's direction
  bool enrich();
  /// Adds the increment to the solution.
  void finish() { Y_ += D_; }

  [[nodiscard]] int pairs() const noexcept { return static_cast<int>(X_.cols()); }
  [[nodiscard]] const RowMatrix& X() const noexcept { return X_; }
  /// Y at the last level of the solution, n x M.
  [[nodiscard]] const Eigen::MatrixXd& Y() const noexcept { return Y_; }
  /// v_s = w_s / (l_s . K0^-1 l_s).
  [[nodiscard]] const Eigen::VectorXd& positionWeights() const noexcept { return v_; }
  /// Replaces X by X V and Y by V^T Y; call it between steps. @param V  n x n', orthonormal columns
  void rotate(const Eigen::MatrixXd& V);

 private:
  [[nodiscard]] Eigen::MatrixXd solveK0(const Eigen::MatrixXd& b) const;
  [[nodiscard]] Eigen::VectorXd displacement(int s) const;
  [[nodiscard]] Eigen::VectorXd load(int s, const Eigen::VectorXd& u) const;
  void weighPositions();
  void solvePosition(int worker, int s);
  [[nodiscard]] Eigen::VectorXd firstGuess() const;
  Eigen::VectorXd sweep(const Eigen::VectorXd& R);
  [[nodiscard]] double normalize(Eigen::VectorXd& R) const;
  void append(const Eigen::VectorXd& R);
  void appendAt(int worker, int s, const Eigen::VectorXd& R);

  const ParametricProblem& problem_;
  const ExplicitOptions& options_;
  int workers_;
  Cholesky K0_;
  Cholesky mean_;  ///< sum_s v_s S_s^2 K_T(u_s)
  TangentTable tangents_;
  Eigen::VectorXd v_;
  Eigen::MatrixXd probes_;  ///< M x probes

  RowMatrix X_;            ///< dofs x n, orthonormal in K0
  Eigen::MatrixXd Y_;      ///< n x M
  Eigen::Index start_{0};  ///< pairs when the step began
  double from_{0.0}, to_{0.0};
  Eigen::MatrixXd D_;               ///< n x M, coefficients of the increment
  Eigen::MatrixXd rho_;             ///< dofs x M, N
  Eigen::MatrixXd b_;               ///< X^T r_s, n x M
  std::vector<Eigen::MatrixXd> T_;  ///< X^T K_T(u_s) X, M of n x n
};

}  // namespace palpate::solver
