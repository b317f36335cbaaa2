// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>

namespace palpate::rt {

/// Lets events through at a rate, and after a pause several at once. Threads: one. Real-time: yes.
class TokenBucket {
 public:
  /// @param per_second  above 0
  /// @param at_once     at least 1
  TokenBucket(double per_second, double at_once) noexcept
      : price_ns_(static_cast<std::int64_t>(1e9 / per_second)),
        saved_ns_(static_cast<std::int64_t>(1e9 / per_second * at_once)) {}

  /// @param now_ns  on a clock that does not go back, at least 0
  [[nodiscard]] bool take(std::int64_t now_ns) noexcept {
    filled_ns_ = std::max(filled_ns_, now_ns - saved_ns_);
    if (now_ns - filled_ns_ < price_ns_) return false;
    filled_ns_ += price_ns_;
    return true;
  }

 private:
  std::int64_t price_ns_;
  std::int64_t saved_ns_;
  std::int64_t filled_ns_{-saved_ns_};  // tokens are the time since then
};

}  // namespace palpate::rt
