// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "palpate/idl/types.h"

namespace palpate::viewer {

/// The viewer's view of the server.
struct ServerState {
  std::string name;  ///< waiting, starting, mismatch, serving, gone
  std::string text;  ///< in words
  friend bool operator==(const ServerState&, const ServerState&) = default;
};

/// Follows one server through starts, ends and restarts. Threads: one.
class ServerWatch {
 public:
  static constexpr std::int64_t kSilenceNs = 2'500'000'000;  ///< a status comes about once a second

  explicit ServerWatch(std::uint32_t domain) : domain_(domain) {}

  /// A status came. Of several servers the watch follows the first until it is gone or stopping.
  /// @return whether the status is from the followed server
  bool saw(const dds::ServerStatus& status, std::int64_t now_ns) noexcept;

  /// @param[in] surface_model  model of the organ's received surface; empty: none
  /// @param[in] mismatch       one line when types on the wire differ, else empty
  [[nodiscard]] ServerState state(std::int64_t now_ns, const std::string& surface_model,
                                  const std::string& mismatch) const;

  /// Whether a status came within kSilenceNs.
  [[nodiscard]] bool alive(std::int64_t now_ns) const noexcept {
    return status_ && now_ns - heard_ns_ <= kSilenceNs;
  }
  /// The newest status, even of a server that is gone; nothing before the first.
  [[nodiscard]] const std::optional<dds::ServerStatus>& status() const noexcept { return status_; }

 private:
  std::uint32_t domain_;
  std::optional<dds::ServerStatus> status_;
  std::int64_t heard_ns_{0};
};

}  // namespace palpate::viewer
