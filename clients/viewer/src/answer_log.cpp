// SPDX-License-Identifier: Apache-2.0
#include "answer_log.h"

#include <algorithm>
#include <map>

namespace palpate::viewer {

void AnswerLog::since(std::uint64_t& place, std::size_t most, std::vector<AnswerRecord>& out) const {
  out.clear();
  const std::uint64_t oldest = count_ > kCapacity ? count_ - kCapacity : 0;
  const std::uint64_t from = std::max(place, oldest);
  place = count_;
  std::map<std::uint32_t, std::size_t> counts;  // of each tool
  for (std::uint64_t i = from; i < count_; ++i) ++counts[ring_[i % kCapacity].tool_id];
  const bool all_fit = count_ - from <= most;
  const std::size_t share = counts.empty() ? 0 : most / counts.size();
  if (share == 0 && !all_fit) return;
  std::map<std::uint32_t, std::size_t> left = counts;
  for (std::uint64_t i = from; i < count_; ++i) {
    const AnswerRecord& answer = ring_[i % kCapacity];
    const std::size_t stride = all_fit ? 1 : (counts[answer.tool_id] + share - 1) / share;
    if (--left[answer.tool_id] % stride == 0) out.push_back(answer);
  }
}

std::int64_t StampClock::toLocal(std::int64_t stamp_ns, std::int64_t received_ns) noexcept {
  constexpr std::int64_t kFurthest = 1LL << 60;  // 36 years: sums below stay within 64 bits
  stamp_ns = std::clamp(stamp_ns, -kFurthest, kFurthest);
  const std::int64_t offset = received_ns - stamp_ns;
  const bool jumped = offset - offset_ns_ > kJumpNs || offset_ns_ - offset > kJumpNs;
  offset_ns_ = !known_ || jumped ? offset : std::min(offset, offset_ns_ + kForgetNs);
  known_ = true;
  return stamp_ns + offset_ns_;
}

}  // namespace palpate::viewer
