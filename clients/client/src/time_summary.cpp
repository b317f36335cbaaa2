// SPDX-License-Identifier: Apache-2.0
#include "palpate/client/time_summary.h"

#include <algorithm>
#include <cmath>

namespace palpate::client {

TimeSummary summaryOf(const rt::CycleStats& times) noexcept {
  const auto us = [](std::int64_t ns) { return static_cast<double>(ns) * 1e-3; };
  return {us(times.quantile(0.5)), us(times.quantile(0.99)), us(times.quantile(0.999)), us(times.max()),
          times.count()};
}

std::vector<HistogramBar> barsOf(const rt::CycleStats& times, int per_decade) {
  std::vector<HistogramBar> bars;
  int first = 0;
  for (std::size_t i = 0; i < rt::CycleStats::kBuckets; ++i) {
    const auto [upper_ns, count] = times.bucket(i);
    if (count == 0) continue;
    const double decade = std::log10(std::max(static_cast<double>(upper_ns), 1.0));
    const int bar = static_cast<int>(std::floor(decade * per_decade));
    if (bars.empty()) first = bar;
    while (static_cast<int>(bars.size()) <= bar - first) {
      const double exponent = first + static_cast<double>(bars.size());
      bars.push_back({std::pow(10.0, exponent / per_decade), std::pow(10.0, (exponent + 1) / per_decade), 0});
    }
    bars.back().count += count;
  }
  return bars;
}

}  // namespace palpate::client
