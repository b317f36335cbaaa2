// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "palpate/idl/types.h"

namespace palpate::viewer {

/// What the viewer waits for, or that it waits for nothing.
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

  /// A status came. Of several servers the first is followed until it is gone or stopping.
  /// @return whether it is of the server that is followed
  bool saw(const dds::ServerStatus& status, std::int64_t now_ns) noexcept;

  /// @param[in] surface_model  model of the organ's surface that came; empty: none
  /// @param[in] mismatch       one line when types on the wire do not fit, else empty
  [[nodiscard]] ServerState state(std::int64_t now_ns, const std::string& surface_model,
                                  const std::string& mismatch) const;

  /// Whether a server runs that was heard of lately.
  [[nodiscard]] bool alive(std::int64_t now_ns) const noexcept {
    return status_ && now_ns - heard_ns_ <= kSilenceNs;
  }
  /// The newest status, also of a server that is gone; nothing before the first.
  [[nodiscard]] const std::optional<dds::ServerStatus>& status() const noexcept { return status_; }

 private:
  std::uint32_t domain_;
  std::optional<dds::ServerStatus> status_;
  std::int64_t heard_ns_{0};
};

}  // namespace palpate::viewer
