// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <string>

namespace palpate::client {

/// Counts how often a server took another model while it ran, by the model's hash in its answers. Another session is another
/// server, or another run of it: no change of the model. Threads: add() on one, count() on any. Real-time: yes.
class ModelChanges {
 public:
  void add(std::uint64_t session, std::uint64_t model_hash) noexcept {
    if (session_ == session && hash_ != model_hash) count_.fetch_add(1, std::memory_order_relaxed);
    session_ = session;
    hash_ = model_hash;
  }
  [[nodiscard]] std::uint64_t count() const noexcept { return count_.load(std::memory_order_relaxed); }

 private:
  std::uint64_t session_{0};  // 0: none yet
  std::uint64_t hash_{0};
  std::atomic<std::uint64_t> count_{0};
};

/// A line for people about so many changes; empty: there were none. Real-time: no.
[[nodiscard]] inline std::string modelChangesText(std::uint64_t count) {
  if (count == 0) return {};
  return "note: the server took another model " +
         (count == 1 ? std::string("once") : std::to_string(count) + " times") +
         " meanwhile: the place that was chosen and the model id are of the organ before\n";
}

}  // namespace palpate::client
