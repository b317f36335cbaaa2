// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>

namespace palpate::modelfile {

/// The value whose rank is nearest to the part q of the way from the first to the last.
/// @param sorted  rising, not empty  @param q  in [0, 1]
[[nodiscard]] inline double quantile(std::span<const double> sorted, double q) noexcept {
  const double rank = q * static_cast<double>(sorted.size() - 1);
  return sorted[static_cast<std::size_t>(rank + 0.5)];
}

}  // namespace palpate::modelfile
