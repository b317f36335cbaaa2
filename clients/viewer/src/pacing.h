// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>

namespace palpate::viewer {

/// How many messages a sender may send: `rate` a second in the long run, `burst` at once. Threads: one.
class TokenBucket {
 public:
  TokenBucket(double rate, double burst) noexcept : rate_(rate), burst_(burst), left_(burst) {}

  /// @return whether there was one left
  [[nodiscard]] bool take(std::int64_t now_ns) noexcept {
    if (last_ns_ != 0)
      left_ = std::min(burst_, left_ + rate_ * 1e-9 * static_cast<double>(now_ns - last_ns_));
    last_ns_ = now_ns;
    if (left_ < 1.0) return false;
    left_ -= 1.0;
    return true;
  }

 private:
  double rate_;
  double burst_;
  double left_;
  std::int64_t last_ns_{0};
};

/// When the next frame may go: `rate` a second in the mean. A source of just that rate, which comes now early, now
/// late, passes whole: half a period early is early enough. Threads: one.
class FramePace {
 public:
  explicit FramePace(double rate_hz) noexcept { setRate(rate_hz); }
  /// @param[in] rate_hz  0: never
  void setRate(double rate_hz) noexcept {
    period_ns_ = rate_hz > 0.0 ? static_cast<std::int64_t>(1e9 / rate_hz) : 0;
  }
  [[nodiscard]] bool due(std::int64_t now_ns) const noexcept {
    return period_ns_ > 0 && now_ns >= next_ns_ - period_ns_ / 2;
  }
  /// One went now.
  void went(std::int64_t now_ns) noexcept {
    next_ns_ = std::max(next_ns_, now_ns - period_ns_ / 2) + period_ns_;
  }

 private:
  std::int64_t period_ns_{0};
  std::int64_t next_ns_{0};
};

}  // namespace palpate::viewer
