// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace palpate::latency {

/// When each pose was sent and when the first force that names it came: what simulations replay (core/devices/sim/delays.h).
/// Threads: sent() on the sender's, answered() on the receive thread; csv() after both.
class SampleLog {
 public:
  static constexpr std::size_t kMost = 10'000'000;  ///< poses that a file may hold

  /// @param[in] capacity  poses; later ones are not kept
  explicit SampleLog(std::size_t capacity) {
    sent_.reserve(capacity);
    answered_.reserve(capacity + kUnmeasured);
  }

  /// @param[in] ns  when the pose went out. Real-time: yes.
  void sent(std::uint64_t seq, std::int64_t ns) noexcept {
    if (sent_.size() < sent_.capacity()) sent_.push_back({seq, ns});
  }
  /// A force came. @param[in] ns  on the clock of sent(). Real-time: yes.
  void answered(std::uint64_t pose_seq, std::int64_t ns) noexcept {
    const bool again = !answered_.empty() && answered_.back().seq == pose_seq;
    if (!again && answered_.size() < answered_.capacity()) answered_.push_back({pose_seq, ns});
  }

  /// A line of names, seq,sent_s,answered_s,lost, and one for each pose (docs/json.md, palpate-latency).
  [[nodiscard]] std::string csv() const;

 private:
  static constexpr std::size_t kUnmeasured = 20'000;  // answers to poses before and after the measurement

  struct Event {
    std::uint64_t seq;
    std::int64_t ns;
  };
  std::vector<Event> sent_;      // seq rises
  std::vector<Event> answered_;  // in the order in which they came
};

}  // namespace palpate::latency
