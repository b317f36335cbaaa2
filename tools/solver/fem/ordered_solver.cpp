// SPDX-License-Identifier: Apache-2.0
#include "tools/solver/fem/ordered_solver.h"

#include <cblas.h>

#include <algorithm>
#include <cstddef>

namespace palpate::solver {

namespace {

/// One supernode s: its block of L, and the rows below its own.
struct Block {
  Block(const Supernodes& f, std::size_t s)
      : first(f.first[s]),
        columns(f.first[s + 1] - first),
        stride(f.row_begin[s + 1] - f.row_begin[s]),
        below(f.rows.subspan(static_cast<std::size_t>(f.row_begin[s] + columns),
                             static_cast<std::size_t>(stride - columns))),
        L(f.values + f.value_begin[s]) {}
  int first, columns, stride;
  std::span<const int> below;
  const double* L;
};

double* rowOf(double* b, int row, int columns) {
  return b + static_cast<std::size_t>(row) * static_cast<std::size_t>(columns);
}

}  // namespace

OrderedSolver::OrderedSolver(const Cholesky& factor)
    : factor_(factor.supernodes()), parent_(factor_.first.size() - 1), working_(parent_.size()) {
  std::vector<int> owner(static_cast<std::size_t>(factor_.first.back()));
  for (std::size_t s = 0; s < parent_.size(); ++s)
    std::fill(owner.begin() + factor_.first[s], owner.begin() + factor_.first[s + 1], static_cast<int>(s));
  for (std::size_t s = 0; s < parent_.size(); ++s) {
    const Block block(factor_, s);
    most_below_ = std::max(most_below_, block.below.size());
    parent_[s] =
        block.below.empty() ? static_cast<int>(s) : owner[static_cast<std::size_t>(block.below.front())];
  }
}

void OrderedSolver::solve(std::span<double> b, int columns) {
  below_.resize(most_below_ * static_cast<std::size_t>(columns));
  findWork(b, columns);
  forward(b.data(), columns);
  backward(b.data(), columns);
}

void OrderedSolver::findWork(std::span<const double> b, int columns) {
  std::fill(working_.begin(), working_.end(), 0);
  for (std::size_t s = 0; s < working_.size(); ++s) {
    const auto begin = b.begin() + static_cast<std::ptrdiff_t>(factor_.first[s]) * columns;
    const auto end = b.begin() + static_cast<std::ptrdiff_t>(factor_.first[s + 1]) * columns;
    if (working_[s] == 0 && std::any_of(begin, end, [](double x) { return x != 0.0; })) working_[s] = 1;
    if (working_[s] != 0) working_[static_cast<std::size_t>(parent_[s])] = 1;
  }
}

/// L y = b. A row is a column of BLAS: it works on the transposed system.
void OrderedSolver::forward(double* b, int columns) {
  for (std::size_t s = 0; s < working_.size(); ++s) {
    if (working_[s] == 0) continue;
    const Block block(factor_, s);
    double* own = rowOf(b, block.first, columns);
    cblas_dtrsm(CblasColMajor, CblasRight, CblasLower, CblasTrans, CblasNonUnit, columns, block.columns, 1.0,
                block.L, block.stride, own, columns);
    if (block.below.empty()) continue;
    cblas_dgemm(CblasColMajor, CblasNoTrans, CblasTrans, columns, static_cast<int>(block.below.size()),
                block.columns, 1.0, own, columns, block.L + block.columns, block.stride, 0.0, below_.data(),
                columns);
    const double* change = below_.data();
    for (const int row : block.below) {
      double* to = rowOf(b, row, columns);
      for (int c = 0; c < columns; ++c) to[c] -= *change++;
    }
  }
}

/// L^T x = y.
void OrderedSolver::backward(double* b, int columns) {
  for (std::size_t s = working_.size(); s-- > 0;) {
    const Block block(factor_, s);
    double* own = rowOf(b, block.first, columns);
    if (!block.below.empty()) {
      double* gathered = below_.data();
      for (const int row : block.below) gathered = std::copy_n(rowOf(b, row, columns), columns, gathered);
      cblas_dgemm(CblasColMajor, CblasNoTrans, CblasNoTrans, columns, block.columns,
                  static_cast<int>(block.below.size()), -1.0, below_.data(), columns, block.L + block.columns,
                  block.stride, 1.0, own, columns);
    }
    cblas_dtrsm(CblasColMajor, CblasRight, CblasLower, CblasNoTrans, CblasNonUnit, columns, block.columns,
                1.0, block.L, block.stride, own, columns);
  }
}

}  // namespace palpate::solver
