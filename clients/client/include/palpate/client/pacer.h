// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace palpate::client {

/// The clock of all stamps that the clients send: CLOCK_MONOTONIC, ns. Real-time: yes.
[[nodiscard]] std::int64_t nowNs() noexcept;

/// Wakes its thread at fixed points in time, not a fixed time after the last wake-up. Periods that were
/// missed are skipped and counted, so a stall is never made up for in a burst. Threads: one. Real-time: yes.
class Pacer {
 public:
  /// @param[in] period_ns  above 0
  explicit Pacer(std::int64_t period_ns) noexcept;

  /// Sleeps until the next point. @return how late it woke, ns, not negative
  std::int64_t wait() noexcept;
  [[nodiscard]] std::uint64_t missed() const noexcept { return missed_; }

 private:
  std::int64_t period_ns_;
  std::int64_t next_ns_;
  std::uint64_t missed_{0};
};

}  // namespace palpate::client
