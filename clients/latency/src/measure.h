// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "latency_log.h"
#include "palpate/client/server_hold.h"
#include "palpate/client/surface.h"
#include "palpate/idl/participant.h"

namespace palpate::latency {

/// Parameters of a measurement.
struct MeasureOptions {
  double seconds{10.0};      ///< of the measurement, in (0, 86400]
  double rate_hz{1000.0};    ///< of the poses, in [10, 4000]
  double tip_radius{0.005};  ///< R, m; the server's
  std::uint32_t tool_id{0};
  bool fields{false};        ///< reads the surface too
  client::ServerRun server;  ///< to be measured
};

/// The sender's side of the measurement.
struct SenderStats {
  rt::CycleStats wakeup;     ///< lateness of the sending thread's wake-ups
  std::int64_t start_ms{0};  ///< of the measurement, since 1970, UTC
  double seconds{0.0};       ///< its duration
  bool server_left{false};   ///< before its end: it said so, or answered nothing for a second
  bool interrupted{false};   ///< before its end
  std::uint64_t sent{0};
  client::LeftOut left_out;   ///< forces of other servers
  std::string left_out_text;  ///< whose; empty: none
  bool realtime{false};
};

/// Presses the organ gently at `spot` and slides there, because a tick has less to do without contact, and fills `log`. The
/// approach before and the retreat after, about one second each, are not measured.
/// @throw client::ClientError  no server takes poses
/// Threads: one for each tool.
[[nodiscard]] SenderStats measure(const dds::Participant& participant, const client::Spot& spot,
                                  const MeasureOptions& options, LatencyLog& log);

}  // namespace palpate::latency
