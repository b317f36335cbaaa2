// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>

#include "palpate/rt/clock.h"
#include "palpate/rt/periodic_thread.h"

namespace palpate::rt {

/// Paces a loop on the calling thread, for a program that needs no PeriodicThread beside it. The grid and the policy for
/// missed periods are those of nextDeadline(). The deadline is judged at the wake-up, so a late cycle still runs.
/// Threads: one.
class Pacer {
 public:
  /// The grid begins now. @param[in] period_ns  raised to 1
  explicit Pacer(std::int64_t period_ns) noexcept
      : period_ns_(std::max<std::int64_t>(period_ns, 1)), next_ns_(monotonicNow() + period_ns_) {}

  /// Sleeps until the next point of the grid. @return how late the thread woke, ns, not negative
  std::int64_t wait() noexcept {
    sleepUntil(next_ns_);
    const std::int64_t due_ns = next_ns_;
    const std::int64_t woke_ns = std::max(monotonicNow(), due_ns);
    const Deadline next = nextDeadline(due_ns, period_ns_, woke_ns);
    next_ns_ = next.ns;
    missed_ += next.missed;
    return woke_ns - due_ns;
  }

  [[nodiscard]] std::uint64_t missed() const noexcept { return missed_; }

 private:
  std::int64_t period_ns_;
  std::int64_t next_ns_;
  std::uint64_t missed_{0};
};

}  // namespace palpate::rt
