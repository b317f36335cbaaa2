// SPDX-License-Identifier: Apache-2.0
#include "palpate/rt/recent_stats.h"

namespace palpate::rt {

void RecentStats::goOn(std::int64_t now_ns) {
  constexpr std::int64_t kSecond = 1'000'000'000;
  if (ends_ns_ == 0) ends_ns_ = now_ns + kSecond;
  if (now_ns < ends_ns_) return;
  const auto over = static_cast<std::size_t>((now_ns - ends_ns_) / kSecond) + 1;
  for (std::size_t i = 0; i < over && i <= kSeconds; ++i) {
    newest_ = (newest_ + 1) % kSeconds;
    seconds_[newest_] = running_;
    running_.clear();
  }
  ends_ns_ += static_cast<std::int64_t>(over) * kSecond;
  minute_.clear();
  for (const CycleStats& second : seconds_) minute_.add(second);
}

}  // namespace palpate::rt
