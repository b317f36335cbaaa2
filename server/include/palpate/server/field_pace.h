// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "palpate/rt/clock.h"

namespace palpate::server {

/// Which surface fields go out: one that changed; and of one that did not, what those need who missed it: at once where
/// a reader came, again shortly after the last change, then once a second (docs/decisions/surface_rate.md).
/// Threads: the tick's. Real-time: yes.
class FieldPace {
 public:
  static constexpr std::int64_t kAgain = 100'000'000;  // ns after the last change: beyond any viewer's frame
  static constexpr std::int64_t kWhole = 1'000'000'000;  // ns

  /// @param readers  Channels::field_readers, not 0
  [[nodiscard]] bool admits(bool changed, std::uint32_t readers,
                            std::int64_t now_ns) noexcept PALPATE_NONBLOCKING {
    const bool news = changed || readers != readers_;
    if (!news && now_ns - sent_ns_ < (again_ ? kWhole : kAgain)) return false;
    again_ = !news;
    readers_ = readers;
    sent_ns_ = now_ns;
    return true;
  }

 private:
  std::int64_t sent_ns_{0};
  std::uint32_t readers_{0};  // as they were at the last field
  bool again_{false};         // the last field sent was one that had been sent before
};

}  // namespace palpate::server
