// SPDX-License-Identifier: Apache-2.0
#include "tools/solver/fem/ordered_solver.h"

#include <algorithm>
#include <cstddef>

namespace palpate::solver {

namespace {

std::vector<BlockOfL> blocksOf(const Supernodes& f) {
  std::vector<BlockOfL> blocks;
  for (std::size_t s = 0; s + 1 < f.first.size(); ++s) {
    const int columns = f.first[s + 1] - f.first[s], stride = f.row_begin[s + 1] - f.row_begin[s];
    blocks.push_back({f.values + f.value_begin[s], f.first[s], columns, stride,
                      f.rows.subspan(static_cast<std::size_t>(f.row_begin[s] + columns),
                                     static_cast<std::size_t>(stride - columns))});
  }
  return blocks;
}

bool isZero(const Lanes& x) {
  for (int lane = 0; lane < kLanes; ++lane)
    if (x[lane] != 0.0) return false;
  return true;
}

}  // namespace

OrderedSolver::OrderedSolver(const Cholesky& factor)
    : blocks_(blocksOf(factor.supernodes())), parent_(blocks_.size()), working_(blocks_.size()) {
  std::vector<std::size_t> owner(factor.order().size());  // of each row
  for (std::size_t s = 0; s < blocks_.size(); ++s)
    std::fill_n(owner.begin() + blocks_[s].first, blocks_[s].columns, s);
  for (std::size_t s = 0; s < blocks_.size(); ++s)
    parent_[s] = blocks_[s].below.empty() ? s : owner[static_cast<std::size_t>(blocks_[s].below.front())];
}

/// L y = b, then L^T x = y.
void OrderedSolver::solve(std::span<Lanes> b, int lanes) {
  findWork(b, lanes);
  for (std::size_t s = 0; s < blocks_.size(); ++s)
    if (working_[s] != 0) solveForward(blocks_[s], b.data(), lanes);
  for (std::size_t s = blocks_.size(); s-- > 0;) solveBackward(blocks_[s], b.data(), lanes);
}

void OrderedSolver::findWork(std::span<const Lanes> b, int lanes) {
  std::fill(working_.begin(), working_.end(), 0);
  const auto of = static_cast<std::size_t>(lanes);
  for (std::size_t s = 0; s < blocks_.size(); ++s) {
    const auto own = b.subspan(static_cast<std::size_t>(blocks_[s].first) * of,
                               static_cast<std::size_t>(blocks_[s].columns) * of);
    if (working_[s] == 0 && !std::all_of(own.begin(), own.end(), isZero)) working_[s] = 1;
    if (working_[s] != 0) working_[parent_[s]] = 1;
  }
}

}  // namespace palpate::solver
