// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "frame.h"

namespace palpate::viewer {

/// The newest answers of all tools, in order of arrival; each reader keeps its own place. Threads: one.
class AnswerLog {
 public:
  static constexpr std::size_t kCapacity = 8192;  ///< two seconds of four tools at 1 kHz

  AnswerLog() : ring_(kCapacity) {}

  void add(const AnswerRecord& answer) noexcept {
    ring_[count_ % kCapacity] = answer;
    ++count_;
  }
  /// Answers since the log began: the place of a reader that has seen them all.
  [[nodiscard]] std::uint64_t end() const noexcept { return count_; }

  /// Answers from `place` on, at most `most` of them. Of more, every n-th of each tool, always with the newest. Answers
  /// that fell out of the log are missing.
  /// @param[in,out] place  moved to end()
  /// @param[out]    out    replaced
  void since(std::uint64_t& place, std::size_t most, std::vector<AnswerRecord>& out) const;

 private:
  std::vector<AnswerRecord> ring_;
  std::uint64_t count_{0};
};

/// Converts one server's stamps to this machine's time; the server may run on another machine. The offset is the least
/// of arrival minus stamp so far, which rises by 100 ns per answer (100 ppm at 1 kHz) so that it follows a drift.
/// Threads: one.
class StampClock {
 public:
  /// @return time of the stamp on this machine's clock, ns; never after its arrival
  [[nodiscard]] std::int64_t toLocal(std::int64_t stamp_ns, std::int64_t received_ns) noexcept;

 private:
  static constexpr std::int64_t kForgetNs = 100;
  static constexpr std::int64_t kJumpNs = 1'000'000'000;
  bool known_{false};
  std::int64_t offset_ns_{0};
};

}  // namespace palpate::viewer
