// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "palpate/client/wanted_server.h"
#include "palpate/idl/reader.h"

namespace palpate::viewer {

/// The viewer's view of the server.
struct ServerState {
  std::string name;      ///< waiting, starting, mismatch, serving, gone
  std::string text;      ///< in words
  std::string others{};  ///< other servers on the domain, in words; empty: none
  friend bool operator==(const ServerState&, const ServerState&) = default;
};

/// Holds on to one run of one server while it lives, then takes the next. Threads: one.
class ServerWatch {
 public:
  static constexpr std::int64_t kSilenceNs = 2'500'000'000;  ///< a status comes about once a second
  static constexpr std::size_t kMostOthers = 16;

  /// @param[in] wanted  of the servers that fit the first that is found is followed
  explicit ServerWatch(std::uint32_t domain, const client::WantedServer& wanted = {})
      : domain_(domain), wanted_(wanted) {}

  /// A status came. Of several servers, or runs of one, the watch follows the first until it is gone or stopping.
  /// @param[in] writer  who sent it: another one that names the followed run is not believed
  /// @return whether the status is from the followed server
  bool saw(const dds::ServerStatus& status, std::int64_t now_ns, dds::WriterId writer = 0);

  /// @param[in] surface_model  model of the organ's received surface; empty: none
  /// @param[in] mismatch       one line when types on the wire differ, else empty
  [[nodiscard]] ServerState state(std::int64_t now_ns, const std::string& surface_model,
                                  const std::string& mismatch) const;

  /// Whether a status came within kSilenceNs.
  [[nodiscard]] bool alive(std::int64_t now_ns) const noexcept {
    return status_ && now_ns - heard_ns_ <= kSilenceNs;
  }
  /// The run that is followed, even when it is gone; 0 before the first.
  [[nodiscard]] std::uint64_t session() const noexcept { return status_ ? status_->session : 0; }
  /// The newest status, even of a server that is gone; nothing before the first.
  [[nodiscard]] const std::optional<dds::ServerStatus>& status() const noexcept { return status_; }

 private:
  struct Other {
    std::string words;
    std::int64_t heard_ns;
  };
  void keepOther(const dds::ServerStatus& status, std::int64_t now_ns);
  [[nodiscard]] std::string othersAt(std::int64_t now_ns) const;
  [[nodiscard]] std::string awaited() const;

  std::uint32_t domain_;
  client::WantedServer wanted_;
  std::optional<dds::ServerStatus> status_;
  dds::WriterId writer_{0};
  std::int64_t heard_ns_{0};
  std::map<std::uint64_t, Other> others_;  // by session
};

}  // namespace palpate::viewer
