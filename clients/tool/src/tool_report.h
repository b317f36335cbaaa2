// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "palpate/client/scripts.h"
#include "palpate/client/server_finder.h"
#include "play.h"
#include "tools/program/json.h"

namespace palpate::tool {

/// The played script, for the reports.
struct Played {
  std::string script;
  client::ScriptOptions options;
  client::Spot spot;
  device::Path path;
  const client::ServerInfo& server;
};

/// For people: a table of force over time, a chart of its size, and a summary line.
[[nodiscard]] std::string tableOf(const Played& played, const Recording& recording);

/// The same for programs: `t_s`[n], `pose_m`[n][3], `force_N`[n][3] (on the tool), `flags`[n],
/// `penetration_m`[n], `work_J`[n], `summary`, and what was played. docs/json.md documents it.
[[nodiscard]] program::Json jsonOf(const Played& played, const Recording& recording);

/// The force's size and components over time, as SVG.
[[nodiscard]] std::string plotOf(const Played& played, const Recording& recording);

}  // namespace palpate::tool
