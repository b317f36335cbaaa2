// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "palpate/rt/cycle_stats.h"

namespace palpate::client {

/// Percentiles of a distribution of times, us.
struct TimeSummary {
  double p50{0.0};
  double p99{0.0};
  double p999{0.0};
  double max{0.0};
  std::uint64_t count{0};
};

[[nodiscard]] TimeSummary summaryOf(const rt::CycleStats& times) noexcept;

/// One bar of a histogram: `count` values in (from_ns, to_ns].
struct HistogramBar {
  double from_ns;
  double to_ns;
  std::uint64_t count;
};

/// Bars of equal width on a logarithmic axis, from the first value to the last. Bars in between may be empty.
/// Without values there is no bar.
/// @param[in] per_decade  bars per factor of ten, in [1, 50]
[[nodiscard]] std::vector<HistogramBar> barsOf(const rt::CycleStats& times, int per_decade);

}  // namespace palpate::client
