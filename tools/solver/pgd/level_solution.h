// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

namespace palpate::solver {

/// u(X, s, t) = sum_k X_k(X) sum_q Z_q(t) Y_{k,q}(s): the paper's solution with the load level separated too.
/// Levels are t_j = j / steps, Z is linear between them and Z_q(0) = 0.                       paper Section 3
struct LevelSolution {
  Eigen::MatrixXd X;  ///< dofs x n, largest entry of each column 1, no unit
  Eigen::MatrixXd Y;  ///< n x (M C), column s C + q, m
  Eigen::MatrixXd Z;  ///< C x (steps + 1), largest entry of each row 1, no unit

  std::vector<int> born;         ///< pairs born in each load step
  std::vector<double> residual;  ///< relative residual at the end of each load step, see ExplicitOptions
  int pairs{0};                  ///< at the end, before X was cut to LevelCut::modes
  int recompressions{0};         ///< number of times that X was recompressed
  double seconds{0.0};

  [[nodiscard]] int modes() const noexcept { return static_cast<int>(X.cols()); }
  [[nodiscard]] int levels() const noexcept { return static_cast<int>(Z.rows()); }
  [[nodiscard]] int steps() const noexcept { return static_cast<int>(Z.cols()) - 1; }
};

/// u(., s, t), dofs, m. @param s  position, 0 .. M - 1  @param t  load level in [0, 1]
/// @throw std::invalid_argument outside
[[nodiscard]] Eigen::VectorXd evaluate(const LevelSolution& solution, int s, double t = 1.0);

/// Y of every load level, as load stepping leaves it.
struct LevelHistory {
  Eigen::MatrixXd X;               ///< dofs x n, orthonormal in K0
  std::vector<Eigen::MatrixXd> Y;  ///< Y_j at t_1 .. t_steps; n_j x M, n_j <= n: later pairs are zero
};

/// How to turn a history into a LevelSolution.
struct LevelCut {
  int modes{0};             ///< X kept, 0 for all
  double tolerance{1e-10};  ///< relative error of the level functions
  int max_levels{119};      ///< level functions, >= 1
};

/// The eigenvectors of sum_j sum_s v_s Y_j(s) Y_j(s)^T, n x n, and its eigenvalues, largest first: X V are the
/// modes of the history in the energy of K0.                                     docs/design.md, Reproduction
struct HistoryModes {
  Eigen::MatrixXd V;
  Eigen::VectorXd energy;  ///< n, >= 0
};
[[nodiscard]] HistoryModes historyModes(const LevelHistory& history, const Eigen::VectorXd& v);

/// Rotates X onto its modes, cuts it, and separates the levels by an SVD over them.
/// @param v  weights of the positions, M, > 0; both SVDs are the best in them
[[nodiscard]] LevelSolution separateLevels(LevelHistory history, const Eigen::VectorXd& v,
                                           const LevelCut& cut);

}  // namespace palpate::solver
