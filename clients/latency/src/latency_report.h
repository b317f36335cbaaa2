// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
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

/// Of several tools' reports each figure at its worst: the longest time, the fewest sent, received and counted, the most of
/// all else; false where one of them is, but true
/// where the server left or the user interrupted. Under `tools` the reports themselves.
[[nodiscard]] program::Json worstOf(const std::vector<program::Json>& tools);

/// What --hdr writes. The log must outlive the result.
/// @param[in] suffix  of the tags
[[nodiscard]] std::vector<TaggedTimes> taggedTimesOf(const LatencyLog& log, const std::string& suffix = {});

/// The three histograms of each tool on logarithmic axes, as SVG.
/// @param[in] logs  with the tools' ids; at least one
[[nodiscard]] std::string plotOf(const std::vector<std::pair<std::uint32_t, const LatencyLog*>>& logs);

}  // namespace palpate::latency
