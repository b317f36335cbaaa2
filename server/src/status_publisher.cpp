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

dds::RecentTimes recent(const rt::RecentStats& stats) {
  return {percentiles(stats.second()), percentiles(stats.minute())};
}

void sayLateTicks(const Health& health, dds::LateTicks& late) {
  const auto count = [&health](rt::LateCause cause) { return health.late[static_cast<std::size_t>(cause)]; };
  late.unknown = count(rt::LateCause::kUnknown);
  late.own_work = count(rt::LateCause::kOwnWork);
  late.page_fault = count(rt::LateCause::kPageFault);
  late.preempted = count(rt::LateCause::kPreempted);
  late.stopped = count(rt::LateCause::kStopped);
  late.host_steal = count(rt::LateCause::kHostSteal);
  late.clock_step = count(rt::LateCause::kClockStep);
  dds::assignText(late.preempted_by, health.preempted_by);
}

void sayTimes(const Health& health, dds::ServerStatus& status) {
  status.tick_us = percentiles(health.tick.run);
  status.tick_recent_us = recent(health.tick.recent);
  status.wakeup_us = percentiles(health.wakeup.run);
  status.wakeup_recent_us = recent(health.wakeup.recent);
  status.receive_us = percentiles(health.receive.run);
  status.receive_recent_us = recent(health.receive.recent);
  status.force_out_us = percentiles(health.force_out.run);
  status.force_out_recent_us = recent(health.force_out.recent);
  sayLateTicks(health, status.late);
  status.clock_steps = health.clock_steps;
  status.clock_step_s = 1e-9 * static_cast<double>(health.clock_step_ns);
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
  sayTimes(health, status);
  status.phase_lock = health.last.phase;
  dds::assignText(status.message, health.message);
  return status;
}

}  // namespace palpate::server
