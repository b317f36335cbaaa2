// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "hdr_log.h"
#include "latency_log.h"
#include "measure.h"
#include "palpate/idl/types.h"
#include "tools/program/json.h"

namespace palpate::latency {

// `server` is its status at the end; in it `late` holds the ticks that were late since the measurement began.

/// For people: the table of percentiles, the counters, and the histogram of the round trip.
[[nodiscard]] std::string textOf(const LatencyLog& log, const SenderStats& sender,
                                 const dds::ServerStatus& server);

/// The same for programs: docs/json.md, palpate-latency.
[[nodiscard]] program::Json jsonOf(const LatencyLog& log, const SenderStats& sender,
                                   const dds::ServerStatus& server);

/// What --hdr writes. The log must outlive the result.
[[nodiscard]] std::vector<TaggedTimes> taggedTimesOf(const LatencyLog& log);

/// The three histograms on logarithmic axes, as SVG.
[[nodiscard]] std::string plotOf(const LatencyLog& log);

}  // namespace palpate::latency
