// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>

namespace palpate::viewer {

/// Limits a sender's messages: `rate` per second in the long run, `burst` at once. Threads: one.
class TokenBucket {
 public:
  TokenBucket(double rate, double burst) noexcept : rate_(rate), burst_(burst), left_(burst) {}

  /// @return whether one more message is allowed
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

}  // namespace palpate::viewer
