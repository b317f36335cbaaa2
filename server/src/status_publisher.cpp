// SPDX-License-Identifier: Apache-2.0
#include "palpate/server/status_publisher.h"

#include <algorithm>

#include "palpate/server/live_limits.h"

namespace palpate::server {
namespace {

dds::Percentiles percentiles(const rt::CycleStats& stats) {
  constexpr double kUs = 1e-3;  // from ns
  dds::Percentiles us{};
  us.p50 = kUs * static_cast<double>(stats.quantile(0.5));
  us.p99 = kUs * static_cast<double>(stats.quantile(0.99));
  us.p999 = kUs * static_cast<double>(stats.quantile(0.999));
  us.max = kUs * static_cast<double>(stats.max());
  us.count = stats.count();
  return us;
}

void sayParameters(const Facts& facts, const Health& health, dds::ServerStatus& status) {
  const LiveParameters live = asFelt(health.settings[0], facts.organ);
  dds::assignText(status.device, facts.device[0]);
  status.speed_limit = facts.step.speed_limit;
  status.tools = static_cast<std::uint32_t>(facts.step.tools);
  for (std::size_t i = 0; i < kLiveParameters.size(); ++i)
    status.*kLiveFields<dds::ServerStatus>[i] = live.*kLiveFields<LiveParameters>[i];
  for (std::size_t tool = 0; tool < health.settings.size(); ++tool) {
    status.tip_radius[tool] = health.settings[tool].tip_radius;
    if (tool < status.tools)
      status.force_limit = std::max(status.force_limit, health.settings[tool].live.force_limit);
  }
  status.parameters_revision = health.parameters_revision;
  status.surplus_requests = health.surplus_requests;
}

}  // namespace

dds::ServerStatus toWire(const Facts& facts, const Health& health, std::uint32_t state) {
  dds::ServerStatus status{};
  status.server_id = facts.server_id;
  status.session = facts.session;
  status.answers_any = facts.answers_any;
  dds::assignText(status.host, facts.host);
  status.pid = facts.pid;
  status.model_hash = facts.model_hash;
  dds::assignText(status.model_id, facts.model_id);
  status.organ_id = facts.organ_id;
  status.state = state;
  status.rate_hz = facts.rate_hz;
  sayParameters(facts, health, status);
  status.memory_locked = facts.memory_locked;
  status.realtime = facts.realtime;
  dds::assignText(status.realtime_detail, facts.realtime_detail);
  status.ticks = health.last.ticks;
  status.overruns = health.last.overruns;
  status.superseded = health.last.superseded;
  status.rejected_poses = health.last.rejected;
  status.unordered_poses = health.last.unordered;
  status.unknown_tools = health.unknown_tools;
  status.misaddressed_poses = health.misaddressed_poses;
  status.rivals = static_cast<std::uint32_t>(health.rivals);
  if (health.rivals > 0) status.rival_s = 1e-9 * static_cast<double>(health.now_ns - health.rival_since_ns);
  dds::assignText(status.rival, health.rival);
  status.dropped = health.last.dropped + health.failed_writes;
  status.flags = health.recent_flags;
  status.tick_us = percentiles(health.tick);
  status.wakeup_us = percentiles(health.wakeup);
  status.phase_lock = health.last.phase;
  dds::assignText(status.message, health.message);
  return status;
}

}  // namespace palpate::server
