// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "palpate/client/server_hold.h"
#include "palpate/idl/tap.h"

namespace palpate::client {

[[nodiscard]] inline ServerRun runOf(const dds::ServerStatus& status) noexcept {
  return {status.server_id, status.session};
}

/// "server 3, session 0123456789abcdef, on HOST, pid 77, model ID".
[[nodiscard]] std::string describe(const dds::ServerStatus& status);

/// A status, and when it came by our monotonic clock.
struct HeardStatus {
  dds::ServerStatus status{};
  dds::WriterId writer{0};
  std::int64_t heard_ns{0};
};

/// The newest status of each server on a domain, of at most kMost. A run belongs to the writer that spoke of it first, while
/// that one is heard. Hears what is sent from its beginning on: within a second each server that runs. Threads: any. Real-time: no.
class StatusBoard {
 public:
  static constexpr std::size_t kMost = 16;
  static constexpr std::int64_t kSilenceNs = 2'500'000'000;  ///< a status comes about once a second

  /// Called on DDS's receive thread after a status was noted.
  using Callback = void (*)(const dds::ServerStatus& status, void* context) noexcept;

  /// @param[in] wants  kHistory: also what servers said last, for a board that does not live long
  /// @throw dds::DdsError
  explicit StatusBoard(const dds::Participant& participant, Callback heard = nullptr, void* context = nullptr,
                       dds::Wants wants = dds::Wants::kNew);

  /// Servers that run and were heard within kSilenceNs, in the order in which they came.
  [[nodiscard]] std::vector<dds::ServerStatus> running() const;
  /// Those that came after a time, in the order in which they came.
  [[nodiscard]] std::vector<HeardStatus> heardAfter(std::int64_t ns) const;
  /// Also of one that is gone.
  [[nodiscard]] std::optional<dds::ServerStatus> find(const ServerRun& run) const;
  [[nodiscard]] std::string mismatch() const { return tap_.mismatch(); }

 private:
  struct Entry {
    dds::ServerStatus status{};
    dds::WriterId writer{0};
    std::int64_t first_ns{0};
    std::int64_t heard_ns{0};  // 0: free
  };
  static void onStatus(const dds::ServerStatus& status, dds::WriterId writer, void* context) noexcept;
  [[nodiscard]] bool note(const dds::ServerStatus& status, dds::WriterId writer,
                          std::int64_t now_ns) noexcept;

  Callback heard_;
  void* context_;
  mutable std::mutex mutex_;
  std::array<Entry, kMost> entries_{};
  dds::Tap<dds::ServerStatus> tap_;  // last: its callback uses the rest
};

}  // namespace palpate::client
