// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <vector>

#include "palpate/rt/late_cause.h"
#include "palpate/rt/periodic_thread.h"

namespace palpate::rt {

/// What the periodic thread had queued by a time.
struct QueueSample {
  std::int64_t at_ns{0};      ///< CLOCK_MONOTONIC, read first
  std::int64_t queued_ns{0};  ///< RunQueueFile
  std::int64_t slack_ns{0};   ///< PeriodicThread::slack()
};

/// What the host had stolen from each processor by a time, in the kernel's units (10 ms).
struct StealSample {
  std::int64_t at_ns{0};  ///< CLOCK_MONOTONIC, read last: what came later is not in it
  std::vector<std::int64_t> stolen;
};

/// What came of a late cycle.
struct LateVerdict {
  LateCycle cycle;
  LateFacts facts;
  LateCause cause{LateCause::kUnknown};
};

/// Joins what the periodic thread says of its late cycles with what another thread saw meanwhile, by time. Knows no /proc: all
/// comes from outside. Threads: one. Real-time: no.
class LateJudge {
 public:
  void note(const QueueSample& sample);
  void note(StealSample sample);
  /// In the order of their times. Samples of before should have been noted.
  void add(const LateCycle& cycle);

  /// Verdicts that are certain by now. A cycle that only the host's steal can explain is held back for the first sample that
  /// tells it, for at most kPatience. It is stolen where the steal grew between the last sample before the cycle and that one; a
  /// steal that came after it explains nothing.
  /// @param[in] at_once  the last ones too
  [[nodiscard]] std::vector<LateVerdict> take(std::int64_t now_ns, bool at_once = false);

  static constexpr std::int64_t kPatience = 300'000'000;  // ns
  static constexpr std::int64_t kStealTold =
      10'000'000;  ///< the kernel accounts for it at its next tick, of 100 Hz or more; ns

 private:
  [[nodiscard]] QueueSample queueBefore(std::int64_t at_ns) const;
  [[nodiscard]] bool stolenFrom(const LateCycle& cycle) const;
  [[nodiscard]] LateFacts factsOf(const LateCycle& cycle) const;

  std::deque<QueueSample> queue_;
  std::deque<StealSample> steal_;
  std::deque<LateVerdict> waiting_;
};

}  // namespace palpate::rt
