// SPDX-License-Identifier: Apache-2.0
#include "tools.h"

#include <algorithm>
#include <cmath>
#include <future>
#include <limits>
#include <string>

#include "palpate/client/error.h"

namespace palpate::latency {

std::vector<client::Spot> spotsApart(const client::Surface& surface, const client::Spot& first,
                                     std::size_t count) {
  std::vector<client::Spot> spots{first};
  std::vector<double> away(surface.positions.size(), std::numeric_limits<double>::infinity());
  for (std::size_t i = 0; i < away.size(); ++i)
    if (surface.accessible[i] == 0) away[i] = 0.0;
  while (spots.size() < count) {
    for (std::size_t i = 0; i < away.size(); ++i)
      away[i] = std::min(away[i], length(surface.positions[i] - spots.back().position));
    const auto farthest = static_cast<std::size_t>(std::max_element(away.begin(), away.end()) - away.begin());
    if (!(away[farthest] > 0.0))
      throw client::ClientError("the organ has " + std::to_string(spots.size()) +
                                " places to press, too few for " + std::to_string(count) + " tools");
    away[farthest] = 0.0;
    const client::Spot spot = client::chooseSpot(surface, surface.positions[farthest]);  // may be a neighbour
    const auto is_same = [&](const client::Spot& other) { return other.node == spot.node; };
    if (std::none_of(spots.begin(), spots.end(), is_same)) spots.push_back(spot);
  }
  return spots;
}

std::vector<std::unique_ptr<ToolMeasurement>> measureTogether(const dds::Participant& participant,
                                                              const client::ServerInfo& server,
                                                              const std::vector<client::Spot>& spots,
                                                              const MeasureOptions& options) {
  std::vector<std::unique_ptr<ToolMeasurement>> tools;
  std::vector<std::future<SenderStats>> senders;
  for (std::size_t i = 0; i < spots.size(); ++i) {
    MeasureOptions own = options;
    own.tool_id = options.tool_id + static_cast<std::uint32_t>(i);
    own.tip_radius = server.status.tip_radius[own.tool_id];
    own.server = runOf(server);
    auto& tool = *tools.emplace_back(std::make_unique<ToolMeasurement>(std::llround(1e9 / options.rate_hz)));
    tool.tool_id = own.tool_id;
    if (own.samples != nullptr) tool.log.keepSamples(own.samples);
    senders.push_back(std::async(std::launch::async, [&participant, &log = tool.log, spot = spots[i], own] {
      return measure(participant, spot, own, log);
    }));
  }
  for (std::size_t i = 0; i < tools.size(); ++i) {
    tools[i]->sender = senders[i].get();  // a thread that threw is told when all have ended: futures wait
    if (tools[i]->log.received() == 0 && tools[i]->sender.interrupted)
      throw client::ClientError("interrupted before a force came back");
    if (tools[i]->log.received() == 0)
      throw client::ClientError("no force came back for " + std::to_string(tools[i]->sender.sent) +
                                " poses of tool " + std::to_string(tools[i]->tool_id));
  }
  return tools;
}

}  // namespace palpate::latency
