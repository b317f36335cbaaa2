// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <string>

#include "palpate/idl/reader.h"
#include "palpate/idl/types.h"

namespace palpate::client {

/// One run of one server.
struct ServerRun {
  std::uint32_t server_id{dds::kServerAny};
  std::uint64_t session{0};  ///< 0: not known yet
  [[nodiscard]] bool operator==(const ServerRun&) const = default;
};

/// "server 3, session 0123456789abcdef".
[[nodiscard]] std::string nameOf(const ServerRun& run);

/// What was left out because another server sent it.
struct LeftOut {
  std::uint64_t count{0};
  ServerRun newest;  ///< who sent the last of it
};

/// Holds on to one server: takes the samples of one run of it, from one writer, and leaves out all others. It takes the next
/// server only when the held one is gone: silent for `silence_ns`, or for kFarewellNs after it said farewell.
/// Threads: takes() on one, the rest on any. Real-time: yes.
class ServerHold {
 public:
  static constexpr std::int64_t kSilenceNs = 1'000'000'000;  ///< a server answers each millisecond
  static constexpr std::int64_t kFarewellNs = 100'000'000;

  /// @param[in] wanted  server_id: only runs of this server, or kServerAny. session: the run that is held from the start, its
  ///                    silence counts from the first address() on; 0: the first that sends
  explicit ServerHold(const ServerRun& wanted = {}, std::int64_t silence_ns = kSilenceNs) noexcept
      : wanted_(wanted.server_id),
        silence_ns_(silence_ns),
        held_(wanted.session != 0),
        id_(wanted.server_id),
        session_(wanted.session) {}

  /// A sample came.
  /// @param[in] eligible  whether its sender may be held on to from here on
  /// @param[in] farewell  the sender said that it ends
  /// @return whether it is of the held server; else it counts as left out
  bool takes(const ServerRun& from, dds::WriterId writer, std::int64_t now_ns, bool eligible = true,
             bool farewell = false) noexcept;

  /// From here on only runs of this server are held on to; the held one stays. Threads: any.
  void want(std::uint32_t server_id) noexcept { wanted_.store(server_id, std::memory_order_relaxed); }

  /// Whom to send to: the held server; while none is held, the wanted one.
  [[nodiscard]] std::uint32_t address(std::int64_t now_ns) noexcept;

  /// The held server, also when it is gone; {kServerAny, 0} before the first.
  [[nodiscard]] ServerRun held() const noexcept;
  /// Rises by one with each server that is held on to.
  [[nodiscard]] std::uint64_t changes() const noexcept { return changes_.load(std::memory_order_relaxed); }
  [[nodiscard]] LeftOut leftOut() const noexcept;

 private:
  [[nodiscard]] bool gone(std::int64_t now_ns) const noexcept;

  std::atomic<std::uint32_t> wanted_;
  std::int64_t silence_ns_;
  dds::WriterId writer_{0};  // takes()'s; 0: the run's first one
  // takes() writes; they order nothing but themselves, and a reader that sees them half changed sees them right at its next look.
  std::atomic<bool> held_;
  std::atomic<bool> farewell_{false};
  std::atomic<std::uint32_t> id_;
  std::atomic<std::uint64_t> session_;
  std::atomic<std::int64_t> heard_ns_{0};  // 0: neither heard nor addressed; address() writes the first
  std::atomic<std::uint64_t> changes_{0};
  std::atomic<std::uint64_t> left_out_{0};
  std::atomic<std::uint32_t> left_out_id_{0};
  std::atomic<std::uint64_t> left_out_session_{0};
};

}  // namespace palpate::client
