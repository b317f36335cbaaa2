// SPDX-License-Identifier: Apache-2.0
#include "tools/solver/pgd/level_solution.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include "tools/solver/base/dense_decompositions.h"

namespace palpate::solver {

namespace {

/// Pairs that were not born yet get rows of zeros.
void padWithZeros(LevelHistory& history) {
  for (Eigen::MatrixXd& Y : history.Y) {
    const Eigen::Index born = Y.rows();
    Y.conservativeResize(history.X.cols(), Y.cols());
    Y.bottomRows(Y.rows() - born).setZero();
  }
}

/// Smallest number of leading values whose remainder is at most tolerance^2 of the sum.
Eigen::Index leading(const Eigen::VectorXd& energy, double tolerance) {
  const double allowed = tolerance * tolerance * energy.sum();
  double tail = 0.0;
  Eigen::Index count = energy.size();
  while (count > 1 && tail + energy[count - 1] <= allowed) tail += energy[--count];
  return count;
}

/// Right singular vectors over the levels, steps x C: projected on them, the history is the best
/// approximation with C level functions.
Eigen::MatrixXd levelVectors(const std::vector<Eigen::MatrixXd>& Y, const Eigen::VectorXd& v,
                             const LevelCut& cut) {
  const auto steps = static_cast<Eigen::Index>(Y.size());
  Eigen::MatrixXd table(Y.front().size(), steps);
  for (Eigen::Index j = 0; j < steps; ++j)
    table.col(j) = (Y[static_cast<std::size_t>(j)] * v.cwiseSqrt().asDiagonal()).reshaped();
  const Eigen::HouseholderQR<Eigen::Ref<Eigen::MatrixXd>> qr(table);
  const Eigen::Index rank = std::min(table.rows(), steps);
  const Eigen::MatrixXd R = table.topRows(rank).triangularView<Eigen::Upper>();
  const SingularValues svd = singularValues(R);
  const Eigen::Index count = leading(svd.values.cwiseAbs2(), cut.tolerance);
  return svd.V.leftCols(std::min<Eigen::Index>(count, cut.max_levels));
}

/// Scales each column of X to a largest entry of 1; Y takes the factor.
void scaleModes(Eigen::MatrixXd& X, Eigen::MatrixXd& Y) {
  for (Eigen::Index k = 0; k < X.cols(); ++k) {
    const double largest = X.col(k).cwiseAbs().maxCoeff();
    X.col(k) /= largest;
    Y.row(k) *= largest;
  }
}

}  // namespace

Eigen::VectorXd evaluate(const LevelSolution& solution, int s, double t) {
  const int C = solution.levels();
  if (!(t >= 0.0) || !(t <= 1.0) || s < 0 || s >= solution.Y.cols() / C)
    throw std::invalid_argument("level solution: position " + std::to_string(s) + ", level " +
                                std::to_string(t) + "; expected positions 0 to " +
                                std::to_string(solution.Y.cols() / C - 1) + " and levels 0 to 1");
  const double place = t * solution.steps();
  const int below = std::min(static_cast<int>(place), solution.steps() - 1);
  const double share = place - below;
  const Eigen::VectorXd z = (1.0 - share) * solution.Z.col(below) + share * solution.Z.col(below + 1);
  return solution.X * (solution.Y.middleCols(static_cast<Eigen::Index>(s) * C, C) * z);
}

HistoryModes historyModes(const LevelHistory& history, const Eigen::VectorXd& v) {
  const Eigen::Index n = history.X.cols();
  Eigen::MatrixXd gram = Eigen::MatrixXd::Zero(n, n);
  for (const Eigen::MatrixXd& Y : history.Y)
    gram.topLeftCorner(Y.rows(), Y.rows()).noalias() += Y * v.asDiagonal() * Y.transpose();
  const Eigenpairs eigen = eigenpairs(gram);
  return {eigen.V, eigen.values.cwiseMax(0.0)};
}

LevelSolution separateLevels(LevelHistory history, const Eigen::VectorXd& v, const LevelCut& cut) {
  LevelSolution solution;
  solution.pairs = static_cast<int>(history.X.cols());
  padWithZeros(history);
  const int modes = cut.modes > 0 ? std::min(cut.modes, solution.pairs) : solution.pairs;
  const Eigen::MatrixXd V = historyModes(history, v).V.leftCols(modes);
  solution.X = history.X * V;
  for (Eigen::MatrixXd& Y : history.Y) Y = V.transpose() * Y;

  const Eigen::MatrixXd vectors = levelVectors(history.Y, v, cut);
  const Eigen::Index C = vectors.cols(), M = v.size();
  solution.Z = Eigen::MatrixXd::Zero(C, vectors.rows() + 1);
  solution.Y = Eigen::MatrixXd::Zero(modes, M * C);
  for (Eigen::Index q = 0; q < C; ++q) {
    const double largest = vectors.col(q).cwiseAbs().maxCoeff();
    solution.Z.row(q).tail(vectors.rows()) = vectors.col(q).transpose() / largest;
    Eigen::MatrixXd Y = Eigen::MatrixXd::Zero(modes, M);
    for (std::size_t j = 0; j < history.Y.size(); ++j)
      Y += largest * vectors(static_cast<Eigen::Index>(j), q) * history.Y[j];
    for (Eigen::Index s = 0; s < M; ++s) solution.Y.col(s * C + q) = Y.col(s);
  }
  scaleModes(solution.X, solution.Y);
  return solution;
}

}  // namespace palpate::solver
