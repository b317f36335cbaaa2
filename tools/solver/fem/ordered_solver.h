// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "tools/solver/fem/cholesky.h"

namespace palpate::solver {

/// Solves K_T x = b with the rows of b in the order of the factor (Cholesky::order()) and the columns of a row
/// side by side, so that nothing is permuted and rows are gathered as they lie. Parts of the forward solve that see
/// only zeros are left out. One object per thread; the factor is shared.
class OrderedSolver {
 public:
  /// @throw std::invalid_argument when the matrix is not positive definite
  explicit OrderedSolver(const Cholesky& factor);
  /// In place. @param b  rows x columns, row by row
  void solve(std::span<double> b, int columns);

 private:
  void forward(double* b, int columns);
  void backward(double* b, int columns);
  void findWork(std::span<const double> b, int columns);

  Supernodes factor_;
  std::vector<int> parent_;    // of a supernode, its own number for a root
  std::vector<char> working_;  // whether the forward solve has something to do there
  std::vector<double> below_;  // rows below a supernode, x columns
  std::size_t most_below_{0};
};

}  // namespace palpate::solver
