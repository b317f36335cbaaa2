// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "palpate/rt/cycle_stats.h"

namespace palpate::rt {

/// Percentiles of durations over the newest second and the newest minute. Whole seconds count: the one that is running is not
/// in either. Threads: one. Real-time: no, 0.5 MB on the heap; a second's end adds up 60 histograms in about 0.1 ms.
class RecentStats {
 public:
  static constexpr std::size_t kSeconds = 60;

  RecentStats() : seconds_(kSeconds) {}

  /// Ends the seconds that are over. Without it what is shown stays as it is. @param[in] now_ns  does not go back
  void goOn(std::int64_t now_ns);

  /// @param[in] ns  a duration, of the second that runs
  void add(std::int64_t ns) noexcept { running_.add(ns); }

  [[nodiscard]] const CycleStats& second() const noexcept { return seconds_[newest_]; }
  [[nodiscard]] const CycleStats& minute() const noexcept { return minute_; }

 private:
  std::vector<CycleStats> seconds_;  // a ring
  std::size_t newest_{0};
  CycleStats running_;
  CycleStats minute_;
  std::int64_t ends_ns_{0};  // of the second that runs; 0: none began
};

}  // namespace palpate::rt
