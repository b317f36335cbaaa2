// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "tools/solver/base/lanes.h"
#include "tools/solver/fem/block_kernel.h"
#include "tools/solver/fem/cholesky.h"

namespace palpate::solver {

/// Solves K_T x = b with the rows of b in the order of the factor (Cholesky::order()) and the columns of a row
/// side by side, so that nothing is permuted and rows are gathered as they lie. Parts of the forward solve that see
/// only zeros are left out. One object per thread; the factor is shared.
class OrderedSolver {
 public:
  /// @throw std::invalid_argument when the matrix is not positive definite
  explicit OrderedSolver(const Cholesky& factor);
  /// In place. @param b  rows of `lanes` Lanes, row by row
  void solve(std::span<Lanes> b, int lanes);

 private:
  void findWork(std::span<const Lanes> b, int lanes);

  std::vector<BlockOfL> blocks_;
  std::vector<std::size_t> parent_;  // of a block, its own number for a root
  std::vector<char> working_;        // whether the forward solve has something to do there
};

}  // namespace palpate::solver
