// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "latency_log.h"
#include "measure.h"
#include "palpate/idl/types.h"
#include "tools/program/json.h"

namespace palpate::latency {

/// For people: the table of percentiles, the counters, and the histogram of the round trip.
[[nodiscard]] std::string textOf(const LatencyLog& log, const SenderStats& sender,
                                 const dds::ServerStatus& server);

/// The same for programs: `pose_to_force_us`, `pose_wait_us`, `pose_to_force_less_wait_us`, `pose_to_field_us` (null: no fields were read), `wakeup_us`, `tick_us`, `client_wakeup_us`, each {p50, p99,
/// p999, max, count}; `overruns`, `lost`, `late`, `superseded`, `seconds` and more.
[[nodiscard]] program::Json jsonOf(const LatencyLog& log, const SenderStats& sender,
                                   const dds::ServerStatus& server);

/// The three histograms on logarithmic axes, as SVG.
[[nodiscard]] std::string plotOf(const LatencyLog& log);

}  // namespace palpate::latency
