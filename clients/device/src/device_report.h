// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "core/devices/sim/mechanics.h"
#include "palpate/client/server_finder.h"
#include "palpate/client/surface.h"
#include "run.h"
#include "tools/program/json.h"

namespace palpate::device {

/// Everything that a report shows.
struct Session {
  std::string preset;
  Mechanics mechanics;
  Hand hand;
  std::string kind;  ///< of the motion
  Motion motion;
  client::Spot spot;
  client::ServerInfo server;
  Recording recording;
  Trace without_organ;
  Verdict verdict;
  EnergyVerdict energy;
  std::string delay_from{};       ///< file of the delays; empty: none
  const Delays* delays{nullptr};  ///< of that file

  /// Whether the run was seen to its end.
  [[nodiscard]] bool complete() const { return !recording.server_left && !recording.interrupted; }
  /// Whether there was a contact: without one nothing is known of the loop.
  [[nodiscard]] bool touched() const { return (recording.flags & dds::flag::kInContact) != 0; }
  /// Whether the run was seen to its end with one, and enough of the hold was without stalls, or a contact without one gained energy.
  [[nodiscard]] bool judged() const { return complete() && touched() && (verdict.judged || !energy.holds()); }
  /// By its motion in the hold, and by the energy of each contact.
  [[nodiscard]] bool stable() const { return touched() && verdict.stable && energy.holds(); }
};

/// For people: the run, a chart of the depth, and the verdict.
[[nodiscard]] std::string textOf(const Session& session);
/// The object of --json (docs/json.md).
[[nodiscard]] program::Json jsonOf(const Session& session);
/// Depth of the tip over time, with and without the organ, as SVG.
[[nodiscard]] std::string plotOf(const Session& session);

}  // namespace palpate::device
