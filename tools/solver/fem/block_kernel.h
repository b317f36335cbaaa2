// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

#include "tools/solver/base/lanes.h"

namespace palpate::solver {

/// A supernode of L: a triangle of as many rows as columns, and the rows below. Column-major.
struct BlockOfL {
  const double* values;
  int first;  ///< row of the triangle's first one
  int columns;
  int stride;  ///< rows of the triangle and below
  std::span<const int> below;
};

/// y of L y = b in the rows of the triangle, and b less L y in the rows below. @param b  all rows, of `lanes` Lanes each
void solveForward(const BlockOfL& block, Lanes* b, int lanes);
/// x of L^T x = y in the rows of the triangle, for the x of the rows below.
void solveBackward(const BlockOfL& block, Lanes* b, int lanes);
/// The instruction set that both take; another one may round otherwise.
[[nodiscard]] std::string blockKernel();

}  // namespace palpate::solver
