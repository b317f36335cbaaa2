// SPDX-License-Identifier: Apache-2.0
#include "tools/examine/bench/samples.h"

#include <algorithm>
#include <numeric>

namespace palpate::bench {

double Samples::quantile(double q) const {
  std::vector<double> sorted = us_;
  const auto rank = static_cast<std::ptrdiff_t>(q * static_cast<double>(sorted.size() - 1));
  std::nth_element(sorted.begin(), sorted.begin() + rank, sorted.end());
  return sorted[static_cast<std::size_t>(rank)];
}

double Samples::sum() const {
  return std::accumulate(us_.begin(), us_.end(), 0.0);
}

void Samples::report(benchmark::State& state) const {
  state.counters["p50_us"] = quantile(0.5);
  state.counters["p99_us"] = quantile(0.99);
}

}  // namespace palpate::bench
