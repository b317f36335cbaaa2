// SPDX-License-Identifier: Apache-2.0
#include "tools/solver/pgd/separated_solution.h"

#include <cstddef>

namespace palpate::solver {

using Eigen::Index;
using Eigen::MatrixXd;

void SeparatedSolution::append(const MatrixXd& R, const std::vector<MatrixXd>& S) {
  const Index before = X.cols();
  X.conservativeResize(R.rows(), before + R.cols());
  X.rightCols(R.cols()) = R;
  Y.resize(S.size());
  for (std::size_t c = 0; c < S.size(); ++c) {
    Y[c].conservativeResize(before + R.cols(), S[c].cols());
    Y[c].bottomRows(R.cols()) = S[c];
  }
}

MatrixXd SeparatedSolution::times(const MatrixXd& P) const {
  if (X.cols() == 0) return MatrixXd::Zero(X.rows(), P.cols());
  MatrixXd v = X * (Y[0] * P);
  for (std::size_t c = 1; c < Y.size(); ++c) {
    const MatrixXd vc = X * (Y[c] * P);
    for (Index i = 0; i < v.rows(); ++i)
      if (components[static_cast<std::size_t>(i)] == static_cast<int>(c)) v.row(i) = vc.row(i);
  }
  return v;
}

MatrixXd SeparatedSolution::project(const MatrixXd& Q) const {
  if (components.empty()) return (Q.transpose() * X) * Y[0];
  const MatrixXd split = byComponent(Q, components, terms());
  MatrixXd result = MatrixXd::Zero(Q.cols(), Y[0].cols());
  for (int c = 0; c < terms(); ++c) {
    const MatrixXd Qc = split(Eigen::all, Eigen::seqN(c, Q.cols(), terms()));
    result += (Qc.transpose() * X) * Y[static_cast<std::size_t>(c)];
  }
  return result;
}

ScalarPairs SeparatedSolution::scalarPairs() const {
  if (components.empty()) return {X, Y.empty() ? MatrixXd() : Y[0]};
  ScalarPairs pairs{byComponent(X, components, terms()), MatrixXd(terms() * X.cols(), Y[0].cols())};
  for (int c = 0; c < terms(); ++c)
    pairs.Y(Eigen::seqN(c, X.cols(), terms()), Eigen::all) = Y[static_cast<std::size_t>(c)];
  return pairs;
}

MatrixXd byComponent(const MatrixXd& R, const std::vector<int>& components, int count) {
  if (components.empty()) return R;
  MatrixXd split = MatrixXd::Zero(R.rows(), R.cols() * count);
  for (Index k = 0; k < R.cols(); ++k)
    for (Index i = 0; i < R.rows(); ++i)
      split(i, k * count + components[static_cast<std::size_t>(i)]) = R(i, k);
  return split;
}

}  // namespace palpate::solver
