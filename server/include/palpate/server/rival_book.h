// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <mutex>
#include <string>
#include <vector>

#include "palpate/idl/reader.h"
#include "palpate/server/facts.h"

namespace palpate::server {

/// Another server, as heard on the wire.
struct OtherServer {
  std::uint32_t server_id{0};
  std::uint64_t session{0};
  dds::WriterId force_writer{0};   ///< 0: no force was heard
  dds::WriterId status_writer{0};  ///< 0: no status was heard
  std::int64_t first_ns{0};        ///< when it was heard first, our monotonic clock
  std::int64_t last_ns{0};         ///< and last
  std::uint32_t state{0};          ///< dds::server_state; what is below is the status's too
  bool answers_any{true};          ///< taken for granted until its status says otherwise
  std::uint32_t pid{0};
  std::array<char, 64> host{};
  std::array<char, 64> model_id{};

  /// False: it only starts.
  [[nodiscard]] bool answers() const noexcept {
    return force_writer != 0 || state == dds::server_state::kRunning;
  }
  [[nodiscard]] bool hasStatus() const noexcept { return status_writer != 0; }
};

/// Which other servers are heard, and which of them are rivals: they answer poses that this server answers, because they have
/// its server_id, or because both answer poses that name no server. Keeps kMost servers: somebody who invents sessions costs
/// a search of that length per sample.
/// Threads: DDS's receive threads hear, one other asks. The receive threads never wait for the lock: what they cannot note
/// is said again. Real-time: hearing allocates nothing.
class RivalBook {
 public:
  static constexpr std::size_t kMost = 16;
  static constexpr std::int64_t kGoneNs =
      3'000'000'000;  ///< silence after which a server is gone; statuses come each second
  static constexpr std::int64_t kGraceNs =
      1'000'000'000;  ///< time for a first status to come, which says what is answered

  explicit RivalBook(const Facts& facts) : facts_(facts) {}

  void heardForce(const dds::ToolForce& force, dds::WriterId writer, std::int64_t now_ns) noexcept;
  void heardStatus(const dds::ServerStatus& status, dds::WriterId writer, std::int64_t now_ns) noexcept;

  /// Rivals that start, run, or send forces; not those that stop or fell silent. A server of another id whose forces came
  /// without a status is one after `grace_ns`.
  [[nodiscard]] std::vector<OtherServer> rivals(std::int64_t now_ns, std::int64_t grace_ns = kGraceNs) const;

  /// Whether a rival said since the last call that it starts.
  [[nodiscard]] bool takeStarter();

 private:
  [[nodiscard]] OtherServer* place(std::uint32_t server_id, std::uint64_t session,
                                   std::int64_t now_ns) noexcept;
  [[nodiscard]] bool clashes(const OtherServer& other) const noexcept;

  const Facts& facts_;
  mutable std::mutex mutex_;  // what is below
  std::array<OtherServer, kMost> others_{};
  bool starter_{false};
};

/// "server 3, session 0123456789abcdef, on HOST, pid 77, model ID": what is known of it.
[[nodiscard]] std::string describe(const OtherServer& other);

}  // namespace palpate::server
