// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <mutex>
#include <string>
#include <vector>

#include "palpate/client/status_board.h"
#include "palpate/client/surface.h"
#include "palpate/client/wanted_server.h"
#include "palpate/idl/reader.h"

namespace palpate::client {

/// What a client needs to know about the server before it starts.
struct ServerInfo {
  dds::ServerStatus status{};
  Surface surface;
};

[[nodiscard]] inline ServerRun runOf(const ServerInfo& server) noexcept {
  return runOf(server.status);
}

/// Finds a running server and its organ's surface on a domain.
class ServerFinder {
 public:
  /// @param[in] wanted  of those that fit the first that is complete is found
  /// @throw dds::DdsError
  explicit ServerFinder(const dds::Participant& participant, const WantedServer& wanted = {});

  /// Waits for a running server's status and for the surface of the same run that fits it (organ id and model id).
  /// @throw ClientError  what is missing (a status, a surface, the right model, the right version of the types),
  ///        or that the user interrupted
  /// Real-time: no.
  [[nodiscard]] ServerInfo wait(std::chrono::milliseconds timeout);

  /// The other servers that run, each in one line.
  [[nodiscard]] std::vector<std::string> others(const ServerInfo& found) const;

 private:
  [[nodiscard]] bool look(ServerInfo& info);
  static bool onSurface(const dds::SurfaceMesh& message, void* context) noexcept;
  void takeSurfaces();
  [[nodiscard]] std::string missing(std::chrono::milliseconds waited) const;

  const dds::Participant& participant_;
  WantedServer wanted_;
  StatusBoard statuses_;
  std::vector<Surface> kept_;
  std::string refusal_;  // of the newest surface that was malformed
  bool has_status_{false};
  std::mutex mutex_;              // the next two
  std::vector<Surface> arrived_;  // DDS's thread adds
  std::string arrived_refusal_;
  dds::Reader<dds::SurfaceMesh> surfaces_;  // last: its filter uses the rest
};

/// ServerFinder::wait() for a program: first says on standard error that it waits, and afterwards which server was chosen if
/// there are several.
[[nodiscard]] ServerInfo findServer(const dds::Participant& participant, double seconds,
                                    const WantedServer& wanted = {});

}  // namespace palpate::client
