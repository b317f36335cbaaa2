// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>

#include "palpate/client/surface.h"
#include "palpate/idl/reader.h"

namespace palpate::client {

/// What a client needs to know about the server before it starts.
struct ServerInfo {
  dds::ServerStatus status{};
  Surface surface;
};

/// Finds a running server and its organ's surface on a domain.
class ServerFinder {
 public:
  /// @throw dds::DdsError
  explicit ServerFinder(const dds::Participant& participant);

  /// Waits for a running server's status and for the surface that fits it (organ id and model id).
  /// @throw ClientError  what is missing (a status, a surface, the right model, the right version of the types),
  ///        or that the user interrupted
  /// Real-time: no.
  [[nodiscard]] ServerInfo wait(std::chrono::milliseconds timeout);

 private:
  [[nodiscard]] bool look(ServerInfo& info);
  [[nodiscard]] std::string missing(std::chrono::milliseconds waited) const;

  std::uint32_t domain_;
  dds::Reader<dds::ServerStatus> statuses_;
  dds::Reader<dds::SurfaceMesh> surfaces_;
  bool has_status_{false};
  bool has_surface_{false};
};

/// ServerFinder::wait() for a program: first says on standard error that it waits.
[[nodiscard]] ServerInfo findServer(const dds::Participant& participant, double seconds);

}  // namespace palpate::client
