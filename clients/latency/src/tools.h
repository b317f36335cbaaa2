// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "measure.h"
#include "palpate/client/server_finder.h"

namespace palpate::latency {

/// What one of several tools measured.
struct ToolMeasurement {
  explicit ToolMeasurement(std::int64_t period_ns) noexcept : log(period_ns) {}

  std::uint32_t tool_id{0};
  LatencyLog log;
  SenderStats sender;
};

/// Places for `count` tools: `first`, then each time the accessible node that lies farthest from those before, so that
/// tools do not press on each other.
/// @throw client::ClientError  the surface has fewer accessible nodes
[[nodiscard]] std::vector<client::Spot> spotsApart(const client::Surface& surface, const client::Spot& first,
                                                   std::size_t count);

/// measure() with one tool for each spot at the same time, each on a thread of its own. Ids count from options.tool_id on.
/// @throw client::ClientError  no server takes the poses, or no force came back for a tool
[[nodiscard]] std::vector<std::unique_ptr<ToolMeasurement>> measureTogether(
    const dds::Participant& participant, const client::ServerInfo& server,
    const std::vector<client::Spot>& spots, const MeasureOptions& options);

}  // namespace palpate::latency
