// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cerrno>
#include <cstdint>
#include <ctime>

namespace palpate::rt {

inline constexpr std::int64_t kMs = 1'000'000;  ///< a millisecond, ns

// Trusted: clock_gettime() reads a page that the kernel keeps up to date (vDSO); there is no system call.
PALPATE_TRUSTED_BEGIN
/// Time on CLOCK_MONOTONIC, the only clock that decides anything here (deadlines, age of a pose), ns.
/// Real-time: yes. Threads: any.
[[nodiscard]] inline std::int64_t monotonicNow() noexcept PALPATE_NONBLOCKING {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return static_cast<std::int64_t>(now.tv_sec) * 1'000'000'000 + now.tv_nsec;
}
PALPATE_TRUSTED_END

/// @param[in] ns  time on any clock, ns, not negative
[[nodiscard]] inline timespec toTimespec(std::int64_t ns) noexcept PALPATE_NONBLOCKING {
  return {static_cast<time_t>(ns / 1'000'000'000), static_cast<long>(ns % 1'000'000'000)};
}

/// Sleeps until a point in time on CLOCK_MONOTONIC; returns at once when it is past. Threads: any.
/// @param[in] deadline_ns  ns, not negative
inline void sleepUntil(std::int64_t deadline_ns) noexcept {
  const timespec until = toTimespec(deadline_ns);
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr) == EINTR) {
  }
}

}  // namespace palpate::rt
