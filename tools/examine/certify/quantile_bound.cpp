// SPDX-License-Identifier: Apache-2.0
#include "tools/examine/certify/quantile_bound.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "tools/modelfile/quantile.h"

namespace palpate::certify {

std::optional<std::size_t> rankOfBound(std::size_t samples) {
  constexpr double kQuantile = 0.95, kRisk = 0.05;
  const auto n = static_cast<double>(samples);
  // P(B >= k), summed from the last rank down, until it would exceed the risk.
  double above = 0.0;
  std::optional<std::size_t> rank;
  for (std::size_t k = samples; k > 0; --k) {
    const auto x = static_cast<double>(k);
    above += std::exp(std::lgamma(n + 1.0) - std::lgamma(x + 1.0) - std::lgamma(n - x + 1.0) +
                      x * std::log(kQuantile) + (n - x) * std::log1p(-kQuantile));
    if (above > kRisk) break;
    rank = k;
  }
  return rank;
}

ErrorStatistics statisticsOf(std::span<const double> errors) {
  std::vector<double> sorted(errors.begin(), errors.end());
  std::sort(sorted.begin(), sorted.end());
  ErrorStatistics s{modelfile::quantile(sorted, 0.5), modelfile::quantile(sorted, 0.95), sorted.back(), {}};
  if (const auto rank = rankOfBound(sorted.size())) s.bound_95_95 = sorted[*rank - 1];
  return s;
}

}  // namespace palpate::certify
