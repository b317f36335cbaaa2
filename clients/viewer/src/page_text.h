// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "palpate/client/surface.h"
#include "palpate/idl/types.h"
#include "server_watch.h"

namespace palpate::viewer {

/// The viewer's own figures in a status.
struct ViewerFigures {
  std::size_t pages{0};
  double frame_rate{0.0};           ///< frames per second to the page that gets the status
  std::uint64_t dropped_fields{0};  ///< that did not fit the surface
};

/// The answer to a page that wants a tool.
struct ToolGrant {
  bool granted{false};
  std::uint32_t tool_id{0};
  std::string message;
};

/// Text messages to a page, JSON as in PROTOCOL.md. Infinity is null; invalid UTF-8 is replaced.
[[nodiscard]] std::string helloText(std::uint64_t page_id, double rate_hz);
[[nodiscard]] std::string stateText(const ServerState& state);
[[nodiscard]] std::string meshText(const client::Surface& surface, std::uint32_t revision, double tip_radius);
[[nodiscard]] std::string statusText(const std::optional<dds::ServerStatus>& status,
                                     const std::optional<dds::ServerParameters>& parameters,
                                     const ViewerFigures& figures);
[[nodiscard]] std::string toolText(const ToolGrant& grant);
[[nodiscard]] std::string parametersText(std::uint64_t request, bool accepted, const std::string& message);
[[nodiscard]] std::string pongText(double t0, double t_us);

}  // namespace palpate::viewer
