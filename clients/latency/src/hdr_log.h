// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "palpate/rt/cycle_stats.h"

namespace palpate::latency {

/// A distribution of times and the tag of its line.
struct TaggedTimes {
  std::string tag;  ///< without commas, blanks and line ends
  const rt::CycleStats* times;
};

/// When a measurement was made.
struct Interval {
  std::int64_t start_ms;  ///< since 1970, UTC
  double seconds;
};

/// An HdrHistogram log, format 1.3: one interval, a line for each tag with values. Values are ns with three significant digits;
/// a bucket of CycleStats counts at its upper edge, the topmost at the largest value, so that readers find the same quantiles.
/// Source: G. Tene, HdrHistogram, encoding V2 (ZigZag LEB128 counts, deflated, base64).
/// @throw std::runtime_error  zlib or OpenSSL fail
[[nodiscard]] std::string hdrLogOf(const std::vector<TaggedTimes>& all, const Interval& interval);

}  // namespace palpate::latency
