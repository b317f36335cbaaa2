// SPDX-License-Identifier: Apache-2.0
#include "tools/solver/pgd/separated_increment.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <random>

#include "tools/solver/base/parallel.h"

namespace palpate::solver {

namespace {

constexpr Eigen::Index kSolvedTogether = 32;  ///< columns per solve with K0

Eigen::MatrixXd gaussian(Eigen::Index rows, Eigen::Index columns, unsigned seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  return Eigen::MatrixXd::NullaryExpr(rows, columns, [&] { return normal(random); });
}

/// K X for a symmetric K: rows of X are contiguous, so one pass over K serves all columns, four entries of a
/// row of K at a time.
void multiply(const TangentTable::View& K, const RowMatrix& X, RowMatrix& product) {
  product.resize(X.rows(), X.cols());
  const int* const starts = K.outerIndexPtr();
  for (Eigen::Index row = 0; row < K.outerSize(); ++row) {
    auto sum = product.row(row);
    sum.setZero();
    const double* k = K.valuePtr() + starts[row];
    const int* at = K.innerIndexPtr() + starts[row];
    const int* const end = K.innerIndexPtr() + starts[row + 1];
    for (; at + 4 <= end; at += 4, k += 4)
      sum += k[0] * X.row(at[0]) + k[1] * X.row(at[1]) + k[2] * X.row(at[2]) + k[3] * X.row(at[3]);
    for (; at < end; ++at, ++k) sum += k[0] * X.row(at[0]);
  }
}

/// Appends a last row and column to a symmetric matrix.
void border(Eigen::MatrixXd& T, const Eigen::VectorXd& row, double corner) {
  const Eigen::Index n = T.rows();
  T.conservativeResize(n + 1, n + 1);
  T.row(n).head(n) = row.transpose();
  T.col(n).head(n) = row;
  T(n, n) = corner;
}

}  // namespace

SeparatedIncrement::SeparatedIncrement(const ParametricProblem& problem, const ExplicitOptions& options)
    : problem_(problem),
      options_(options),
      workers_(options.workers > 0 ? options.workers : machineThreads()),
      K0_(problem.stiffness()),
      mean_(problem.stiffness()),
      tangents_(problem, options.tangent_bytes, workers_),
      X_(problem.dofs(), 0),
      Y_(0, problem.positions()),
      D_(0, problem.positions()),
      rho_(problem.dofs(), problem.positions()),
      b_(0, problem.positions()),
      T_(static_cast<std::size_t>(problem.positions())) {
  K0_.requirePositiveDefinite("the stiffness matrix");
  weighPositions();
  if (problem.positions() > options.exact_residuals)
    probes_ = gaussian(problem.positions(), options.probes, 1);
}

/// K0^-1 b, blocks of columns side by side.
Eigen::MatrixXd SeparatedIncrement::solveK0(const Eigen::MatrixXd& b) const {
  Eigen::MatrixXd x = b;
  const Eigen::Index blocks = (b.cols() + kSolvedTogether - 1) / kSolvedTogether;
  parallelFor(workers_, static_cast<std::size_t>(blocks), [&](int, std::size_t block) {
    const Eigen::Index first = static_cast<Eigen::Index>(block) * kSolvedTogether;
    Cholesky::Solver(K0_).solveInPlace(x.middleCols(first, std::min(kSolvedTogether, b.cols() - first)));
  });
  return x;
}

Eigen::VectorXd SeparatedIncrement::displacement(int s) const {
  if (start_ == 0) return Eigen::VectorXd::Zero(problem_.dofs());
  return X_.leftCols(start_) * Y_.col(s).head(start_);
}

void SeparatedIncrement::weighPositions() {
  const Eigen::Index M = problem_.positions();
  v_.resize(M);
  const Eigen::Index together = kSolvedTogether * workers_;
  for (Eigen::Index first = 0; first < M; first += together) {
    const Eigen::Index count = std::min(together, M - first);
    const Eigen::MatrixXd loads = problem_.loads().middleCols(first, count);
    const Eigen::VectorXd compliance = loads.cwiseProduct(solveK0(loads)).colwise().sum();
    v_.segment(first, count) = problem_.weights().segment(first, count).cwiseQuotient(compliance);
  }
}

Eigen::VectorXd SeparatedIncrement::load(int s, const Eigen::VectorXd& u) const {
  const Eigen::VectorXd l = problem_.loads().col(s);
  if (options_.scheme == LoadStepping::kForwardEuler) return (to_ - from_) * l;
  return to_ * l - problem_.internalForce(u);
}

void SeparatedIncrement::begin(double from, double to) {
  from_ = from;
  to_ = to;
  start_ = pairs();
  tangents_.holdConstant(start_ == 0 || options_.scheme == LoadStepping::kConstantTangent);
  D_.resize(start_, problem_.positions());
  b_.resize(start_, problem_.positions());
  parallelFor(workers_, static_cast<std::size_t>(problem_.positions()),
              [&](int worker, std::size_t s) { solvePosition(worker, static_cast<int>(s)); });
}

void SeparatedIncrement::solvePosition(int worker, int s) {
  thread_local RowMatrix KX;
  const Eigen::VectorXd u = displacement(s);
  const TangentTable::View K = tangents_.assemble(worker, s, u);
  rho_.col(s) = load(s, u);
  Eigen::MatrixXd& T = T_[static_cast<std::size_t>(s)];
  if (start_ == 0) return;  // BLAS takes no empty matrices
  multiply(K, X_, KX);
  T.noalias() = X_.transpose() * KX;
  b_.col(s).noalias() = X_.transpose() * rho_.col(s);
  D_.col(s) = T.partialPivLu().solve(b_.col(s));
  rho_.col(s).noalias() -= KX * D_.col(s);
}

double SeparatedIncrement::residual() const {
  const bool carried = options_.scheme != LoadStepping::kForwardEuler;
  const double reference = carried ? to_ : to_ - from_;
  const Eigen::VectorXd scale = v_.cwiseSqrt();
  if (probes_.size() == 0) {
    const Eigen::MatrixXd scaled = rho_ * scale.asDiagonal();
    const Eigen::VectorXd squares = scaled.cwiseProduct(solveK0(scaled)).colwise().sum();
    return std::sqrt(squares.cwiseQuotient(problem_.weights()).maxCoeff()) / reference;
  }
  const Eigen::MatrixXd mixed = rho_ * (scale.asDiagonal() * probes_);
  const double mean = mixed.cwiseProduct(solveK0(mixed)).sum() / static_cast<double>(probes_.cols());
  return std::sqrt(mean / problem_.weights().sum()) / reference;
}

/// K0^-1 of a random combination of the residuals: one step of a power iteration.
Eigen::VectorXd SeparatedIncrement::firstGuess() const {
  const Eigen::VectorXd z = gaussian(problem_.positions(), 1, static_cast<unsigned>(1000 + pairs()));
  return K0_.solve(rho_ * v_.cwiseSqrt().cwiseProduct(z));
}

/// Makes it orthogonal to X and of unit length in K0. @return relative length before scaling
double SeparatedIncrement::normalize(Eigen::VectorXd& R) const {
  const auto length = [&] { return std::sqrt(std::max(R.dot(problem_.stiffness() * R), 0.0)); };
  R /= length();
  double left = 1.0;
  for (int pass = 0; pass < 2 && pairs() > 0; ++pass) {
    R -= X_ * (X_.transpose() * (problem_.stiffness() * R));
    const double now = length();
    left *= now;
    R /= now;
  }
  return left;
}

/// S from R, then R from S, in one pass over the tangents.                      paper Sections 2.1 and 2.2
Eigen::VectorXd SeparatedIncrement::sweep(const Eigen::VectorXd& R) {
  if (tangents_.constant()) {  // the length of R does not matter, and every K_s R is the same
    const Eigen::VectorXd S = rho_.transpose() * R;
    return K0_.solve(rho_ * v_.cwiseProduct(S));
  }
  const Eigen::Index nonzeros = problem_.stiffness().nonZeros();
  Eigen::MatrixXd values = Eigen::MatrixXd::Zero(nonzeros, workers_);
  Eigen::MatrixXd g = Eigen::MatrixXd::Zero(problem_.dofs(), workers_);
  parallelFor(workers_, static_cast<std::size_t>(problem_.positions()), [&](int worker, std::size_t at) {
    const int s = static_cast<int>(at);
    const TangentTable::View K = tangents_.at(worker, s, [&] { return displacement(s); });
    const double S = R.dot(rho_.col(s)) / R.dot(K.transpose() * R);
    values.col(worker) += v_[s] * S * S * Eigen::Map<const Eigen::VectorXd>(K.valuePtr(), nonzeros);
    g.col(worker) += v_[s] * S * rho_.col(s);
  });
  SparseMatrix mean = problem_.stiffness();
  Eigen::Map<Eigen::VectorXd>(mean.valuePtr(), nonzeros) = values.rowwise().sum();
  mean_.factorize(mean);
  return mean_.solve(g.rowwise().sum());
}

bool SeparatedIncrement::enrich() {
  Eigen::VectorXd R = firstGuess();
  for (int i = 0; i < options_.sweeps; ++i) {
    if (!(R.norm() > 0.0)) return false;
    R = sweep(R / R.cwiseAbs().maxCoeff());
  }
  const double left = normalize(R);
  if (!(left > 1e-12)) return false;
  append(R);
  return true;
}

void SeparatedIncrement::append(const Eigen::VectorXd& R) {
  const Eigen::Index n = pairs();
  for (Eigen::MatrixXd* coefficients : {&Y_, &D_, &b_}) {
    coefficients->conservativeResize(n + 1, coefficients->cols());
    coefficients->row(n).setZero();
  }
  X_.conservativeResize(X_.rows(), n + 1);
  X_.col(n) = R;
  parallelFor(workers_, static_cast<std::size_t>(problem_.positions()),
              [&](int worker, std::size_t s) { appendAt(worker, static_cast<int>(s), R); });
}

void SeparatedIncrement::appendAt(int worker, int s, const Eigen::VectorXd& R) {
  const TangentTable::View K = tangents_.at(worker, s, [&] { return displacement(s); });
  const Eigen::Index n = X_.cols() - 1;
  const Eigen::VectorXd KR = K.transpose() * R;
  const Eigen::VectorXd row = X_.transpose() * KR;
  Eigen::MatrixXd& T = T_[static_cast<std::size_t>(s)];
  border(T, row.head(n), row[n]);
  b_(n, s) = R.dot(rho_.col(s)) + row.head(n).dot(D_.col(s).head(n));
  const Eigen::VectorXd d = T.partialPivLu().solve(b_.col(s));
  const Eigen::VectorXd change = X_ * (d - D_.col(s));
  rho_.col(s).noalias() -= K.transpose() * change;
  D_.col(s) = d;
}

void SeparatedIncrement::rotate(const Eigen::MatrixXd& V) {
  X_ = (X_ * V).eval();
  Y_ = (V.transpose() * Y_).eval();
  start_ = pairs();
}

}  // namespace palpate::solver
