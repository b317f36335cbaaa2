// SPDX-License-Identifier: Apache-2.0
#include "tools/solver/pgd/alternating_directions.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <random>
#include <utility>

#include "tools/solver/base/parallel.h"
#include "tools/solver/pgd/recompression.h"

namespace palpate::solver {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

std::size_t at(Index i) {
  return static_cast<std::size_t>(i);
}

int countOf(const std::vector<int>& components) {
  return components.empty() ? 1 : 1 + *std::max_element(components.begin(), components.end());
}

/// The non-zero columns after Gram-Schmidt.
MatrixXd independentColumns(const MatrixXd& Q) {
  std::vector<Index> kept;
  for (Index j = 0; j < Q.cols(); ++j)
    if (!Q.col(j).isZero(0.0)) kept.push_back(j);
  return Q(Eigen::all, kept);
}

/// Stacks the rows of S, those of one pair together: (b components) x M.
MatrixXd stacked(const NewPairs& pairs) {
  const auto count = static_cast<Index>(pairs.S.size());
  MatrixXd S(pairs.R.cols() * count, pairs.S[0].cols());
  for (Index c = 0; c < count; ++c) S(Eigen::seqN(c, pairs.R.cols(), count), Eigen::all) = pairs.S[at(c)];
  return S;
}

}  // namespace

AlternatingDirections::AlternatingDirections(const SparseMatrix& K, const SeparatedLoad& load,
                                             const VectorXd& weights, const LinearPgdOptions& options,
                                             std::vector<int> components)
    : K_(K),
      load_(load),
      weights_(weights),
      options_(options),
      components_(std::move(components)),
      count_(countOf(components_)),
      factor_(K) {
  factor_.requirePositiveDefinite("the stiffness matrix");
}

MatrixXd AlternatingDirections::solve(const MatrixXd& B) const {
  const Index share = std::max<Index>(1, (B.cols() + options_.workers - 1) / options_.workers);
  MatrixXd x = B;
  parallelFor(options_.workers, at((B.cols() + share - 1) / share), [&](int, std::size_t chunk) {
    const Index first = static_cast<Index>(chunk) * share;
    Cholesky::Solver(factor_).solveInPlace(x.middleCols(first, std::min(share, B.cols() - first)));
  });
  return x;
}

/// The same S for all components: the first R-step is then that of a scalar pair.
NewPairs AlternatingDirections::randomPairs(int block) {
  std::mt19937 random(options_.seed * 7919U + drawn_++);
  std::normal_distribution<double> normal;
  const MatrixXd S = MatrixXd::NullaryExpr(block, weights_.size(), [&] { return normal(random); });
  NewPairs pairs;
  pairs.R = MatrixXd::Zero(K_.rows(), block);
  pairs.S.assign(at(count_), S * weights_.cwiseSqrt().cwiseInverse().asDiagonal());
  return pairs;
}

void AlternatingDirections::stepR(const SeparatedSolution& u, NewPairs& pairs) {
  if (count_ == 1)
    stepScalarR(u, pairs);
  else
    stepHadamardR(u, pairs);
}

/// K R int S S^T = int (l - K u^n) S^T. Any basis of the span of S gives the same span of R; this one is
/// orthonormal.
void AlternatingDirections::stepScalarR(const SeparatedSolution& u, NewPairs& pairs) const {
  const MatrixXd basis =
      independentColumns(orthonormalize(pairs.S[0].transpose(), diagonalProduct(weights_)).Q);
  const MatrixXd P = weights_.asDiagonal() * basis;
  MatrixXd rhs = load_.times(P);
  if (u.pairs() > 0) rhs -= K_ * u.times(P);
  pairs.R = independentColumns(orthonormalize(solve(rhs), energyProduct(K_)).Q);
}

void AlternatingDirections::stepHadamardR(const SeparatedSolution& u, NewPairs& pairs) {
  const MatrixXd S = stacked(pairs);
  const MatrixXd P = weights_.asDiagonal() * S.transpose();
  Eigen::MatrixXd G = S * P;                  // int S_i S_j ds
  G.diagonal().array() += 1e-13 * G.trace();  // for a component without any displacement
  MatrixXd rhs = load_.times(P);
  if (u.pairs() > 0) rhs -= K_ * u.times(P);
  VectorXd r(K_.rows());
  for (Index i = 0; i < r.size(); ++i) r[i] = rhs(i, components_[at(i)]);
  blocks_ = K_;
  for (Index column = 0; column < K_.outerSize(); ++column)
    for (SparseMatrix::InnerIterator entry(blocks_, column); entry; ++entry)
      entry.valueRef() *= G(components_[at(entry.row())], components_[at(column)]);
  if (!blocks_factor_)
    blocks_factor_ = std::make_unique<Cholesky>(blocks_);
  else
    blocks_factor_->factorize(blocks_);
  blocks_factor_->requirePositiveDefinite("the matrix of an R-step");
  pairs.R = blocks_factor_->solve(r);
  const MatrixXd split = byComponent(pairs.R, components_, count_);
  const VectorXd squares = split.cwiseProduct(K_ * split).colwise().sum().transpose();
  for (Index i = 0; i < r.size(); ++i) {
    const double square = squares[components_[at(i)]];
    pairs.R(i, 0) = square > 0.0 ? pairs.R(i, 0) / std::sqrt(square) : 0.0;
  }
}

void AlternatingDirections::stepS(const SeparatedSolution& u, NewPairs& pairs) const {
  const MatrixXd split = byComponent(pairs.R, components_, count_);
  const MatrixXd Q = K_ * split;
  const MatrixXd A = split.transpose() * Q;
  MatrixXd b = load_.project(split);
  if (u.pairs() > 0) b -= u.project(Q);
  const MatrixXd S = A.completeOrthogonalDecomposition().solve(b);
  pairs.energy = S.cwiseProduct(b).colwise().sum().dot(weights_);
  for (Index c = 0; c < count_; ++c) pairs.S[at(c)] = S(Eigen::seqN(c, pairs.R.cols(), count_), Eigen::all);
}

/// Distance of the two fields, each of norm 1.
double AlternatingDirections::change(const NewPairs& before, const NewPairs& after) const {
  if (before.energy <= 0.0 || after.energy <= 0.0) return 1.0;
  const MatrixXd A = byComponent(before.R, components_, count_).transpose() *
                     (K_ * byComponent(after.R, components_, count_));
  const MatrixXd G = stacked(before) * weights_.asDiagonal() * stacked(after).transpose();
  const double cosine = A.cwiseProduct(G).sum() / std::sqrt(before.energy * after.energy);
  return std::sqrt(std::max(0.0, 2.0 - 2.0 * cosine));
}

NewPairs AlternatingDirections::enrich(const SeparatedSolution& u, int block) {
  NewPairs pairs = randomPairs(block);
  for (int sweep = 1; sweep <= options_.max_sweeps; ++sweep) {
    NewPairs next = pairs;
    stepR(u, next);
    if (next.R.cols() == 0) return next;
    stepS(u, next);
    next.sweeps = sweep;
    const double changed = change(pairs, next);
    pairs = std::move(next);
    if (changed <= options_.pair_tolerance) break;
  }
  return pairs;
}

}  // namespace palpate::solver
