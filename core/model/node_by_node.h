// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace palpate {

/// The modes node by node: [Ns][3][n] from [n][Ns][3]. Not real-time.
[[nodiscard]] inline std::vector<float> nodeByNode(std::span<const float> X, std::size_t modes) {
  const std::size_t rows = modes > 0 ? X.size() / modes : 0;
  std::vector<float> by_node(X.size());
  for (std::size_t k = 0; k < modes; ++k)
    for (std::size_t row = 0; row < rows; ++row) by_node[row * modes + k] = X[k * rows + row];
  return by_node;
}

}  // namespace palpate
