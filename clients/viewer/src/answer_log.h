// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "frame.h"

namespace palpate::viewer {

/// The newest answers of all tools, in the order in which they came; each reader keeps its own place. Threads: one.
class AnswerLog {
 public:
  static constexpr std::size_t kCapacity = 8192;  ///< two seconds of four tools at 1 kHz

  AnswerLog() : ring_(kCapacity) {}

  void add(const AnswerRecord& answer) noexcept {
    ring_[count_ % kCapacity] = answer;
    ++count_;
  }
  /// Answers since the log began: the place of a reader who has seen them all.
  [[nodiscard]] std::uint64_t end() const noexcept { return count_; }

  /// Answers from `place` on, at most `most` of them: when there are more, of each tool every n-th, the newest always
  /// among them. Those that fell out of the log are left out.
  /// @param[in,out] place  moved to end()
  /// @param[out]    out    replaced
  void since(std::uint64_t& place, std::size_t most, std::vector<AnswerRecord>& out) const;

 private:
  std::vector<AnswerRecord> ring_;
  std::uint64_t count_{0};
};

/// Turns a server's stamps into this machine's time. The clock may be another machine's: the offset is the least seen
/// of arrival less stamp, which forgets at 100 ppm of 1 kHz answers. One server's: another needs a new one.
/// Threads: one.
class StampClock {
 public:
  /// @return when the stamp was made, this machine's clock, ns; never after its arrival
  [[nodiscard]] std::int64_t toLocal(std::int64_t stamp_ns, std::int64_t received_ns) noexcept;

 private:
  static constexpr std::int64_t kForgetNs = 100;
  static constexpr std::int64_t kJumpNs = 1'000'000'000;
  bool known_{false};
  std::int64_t offset_ns_{0};
};

}  // namespace palpate::viewer
