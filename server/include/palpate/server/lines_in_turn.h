// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <string>
#include <utility>
#include <vector>

namespace palpate::server {

/// Lines that strangers cause, as many as they like, told one at a time: some wait for their turn, of the rest the number is told.
/// Threads: one. Real-time: no.
class LinesInTurn {
 public:
  static constexpr std::size_t kMostWaiting = 16;

  void add(std::vector<std::string> lines) {
    for (std::string& line : lines) {
      if (waiting_.size() < kMostWaiting)
        waiting_.push_back(std::move(line));
      else
        ++left_out_;
    }
  }
  [[nodiscard]] bool empty() const noexcept { return waiting_.empty(); }
  /// The first that waits; not of an empty one.
  [[nodiscard]] std::string next() {
    std::string line = std::move(waiting_.front());
    waiting_.pop_front();
    if (const std::uint64_t count = std::exchange(left_out_, 0); count > 0)
      line += " (" + std::to_string(count) + " more left out)";
    return line;
  }

 private:
  std::deque<std::string> waiting_;
  std::uint64_t left_out_{0};
};

}  // namespace palpate::server
