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

/// One line: both peak forces, and by how much the first is larger.
[[nodiscard]] std::string comparisonOf(const Recording& recording, const Recording& beside);

/// The force's size over depth at both places, as SVG.
[[nodiscard]] std::string plotOfBoth(const Played& played, const Recording& recording, const Played& other,
                                     const Recording& beside);

}  // namespace palpate::tool
