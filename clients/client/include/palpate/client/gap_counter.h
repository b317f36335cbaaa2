// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace palpate::client {

/// Counts samples lost on the way, from a counter that rises by one with each. Another session, or a counter that falls back,
/// means that the sender was restarted. Threads: one. Real-time: yes.
class GapCounter {
 public:
  void add(std::uint64_t session, std::uint64_t seq) noexcept {
    const bool same = session == session_ && seq > last_;
    if (received_ > 0 && !same) ++restarts_;
    if (received_ > 0 && same) lost_ += seq - last_ - 1;
    session_ = session;
    last_ = seq;
    ++received_;
  }
  [[nodiscard]] std::uint64_t received() const noexcept { return received_; }
  [[nodiscard]] std::uint64_t lost() const noexcept { return lost_; }
  [[nodiscard]] std::uint64_t restarts() const noexcept { return restarts_; }

 private:
  std::uint64_t session_{0};
  std::uint64_t last_{0};
  std::uint64_t received_{0};
  std::uint64_t lost_{0};
  std::uint64_t restarts_{0};
};

}  // namespace palpate::client
