// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>

namespace palpate::client {

/// Times the frames: `rate` per second in the mean. A frame may go up to half a period early, so a source of the same rate
/// with jitter passes whole; the first after a pause makes the next one wait a whole period. A new rate holds at once.
/// Threads: one.
class FramePace {
 public:
  static constexpr std::int64_t kLongestNs = 10'000'000'000;  ///< between frames; the slowest rate

  explicit FramePace(double rate_hz) noexcept { setRate(rate_hz); }
  /// @param[in] rate_hz  0: never
  void setRate(double rate_hz) noexcept {
    constexpr auto kLongest = static_cast<double>(kLongestNs);
    const std::int64_t period_ns =
        rate_hz > 0.0 ? static_cast<std::int64_t>(std::clamp(1e9 / rate_hz, 1.0, kLongest)) : 0;
    if (period_ns != period_ns_) planned_ns_ = std::min(planned_ns_, went_ns_);
    period_ns_ = period_ns;
  }
  /// @return whether a frame may go now
  [[nodiscard]] bool due(std::int64_t now_ns) const noexcept {
    return period_ns_ > 0 && now_ns >= planned_ns_ + period_ns_ - period_ns_ / 2;
  }
  /// A frame goes now.
  void went(std::int64_t now_ns) noexcept {
    const bool paused = now_ns - planned_ns_ > 2 * period_ns_;
    planned_ns_ = paused ? now_ns + period_ns_ / 2 : planned_ns_ + period_ns_;
    went_ns_ = now_ns;
  }
  /// due(), and then went(). @param[in] now_ns  on any clock that does not go back
  [[nodiscard]] bool admits(std::int64_t now_ns) noexcept {
    const bool admitted = due(now_ns);
    if (admitted) went(now_ns);
    return admitted;
  }

 private:
  std::int64_t period_ns_{0};
  std::int64_t planned_ns_{-kLongestNs};  // planned time of the newest frame, at most half a period ahead
  std::int64_t went_ns_{-kLongestNs};     // when it went
};

}  // namespace palpate::client
