// SPDX-License-Identifier: Apache-2.0
#include "sample_log.h"

#include <algorithm>
#include <limits>

#include "tools/program/printed.h"

namespace palpate::latency {

std::string SampleLog::csv() const {
  constexpr std::int64_t kNone = std::numeric_limits<std::int64_t>::min();
  std::vector<std::int64_t> answer(sent_.size(), kNone);
  for (const Event& event : answered_) {
    const auto pose = std::lower_bound(sent_.begin(), sent_.end(), event.seq,
                                       [](const Event& one, std::uint64_t seq) { return one.seq < seq; });
    if (pose == sent_.end() || pose->seq != event.seq) continue;
    std::int64_t& first = answer[static_cast<std::size_t>(pose - sent_.begin())];
    if (first == kNone) first = event.ns;
  }
  std::string text = "seq,sent_s,answered_s,lost\n";
  const auto seconds = [&](std::int64_t ns) { return 1e-9 * static_cast<double>(ns - sent_.front().ns); };
  for (std::size_t i = 0; i < sent_.size(); ++i) {
    text +=
        std::to_string(sent_[i].seq - sent_.front().seq) + program::printed(",%.9f,", seconds(sent_[i].ns));
    text +=
        answer[i] == kNone ? ",1\n" : program::printed("%.9f,0\n", seconds(std::max(answer[i], sent_[i].ns)));
  }
  return text;
}

}  // namespace palpate::latency
