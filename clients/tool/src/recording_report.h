// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "palpate/client/server_finder.h"
#include "play_recording.h"
#include "tools/program/json.h"

namespace palpate::tool {

/// A session that was played back, for the reports.
struct PlayedBack {
  std::string file;
  const RecordedSession& session;
  const Playback& playback;
  const client::ServerInfo& server;
  std::optional<double> within;  ///< share of the largest recorded force that forces may differ by

  /// Whether there is anything to judge: the session was played whole, and a tool touched the organ when it was recorded.
  [[nodiscard]] bool isJudged() const noexcept;
  /// Whether all tools' forces are within that. False where nothing is judged or it was not asked.
  [[nodiscard]] bool holds() const noexcept;
};

/// What may make the forces differ, one line each: another organ, another tip, live parameters that changed. Empty: nothing is
/// known to.
[[nodiscard]] std::string notesOf(const std::string& file, const RecordedSession& session,
                                  std::optional<std::uint32_t> as, const client::ServerInfo& server);

/// For people: for each tool a table of both forces over time, a chart, and a summary line.
[[nodiscard]] std::string tableOf(const PlayedBack& played);

/// The same for programs; docs/json.md documents it.
[[nodiscard]] program::Json jsonOf(const PlayedBack& played);

/// The size of both forces over time, as SVG.
[[nodiscard]] std::string plotOf(const PlayedBack& played);

}  // namespace palpate::tool
