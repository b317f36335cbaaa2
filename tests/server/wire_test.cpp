// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <utility>

#include "palpate/rt/phase_lock.h"
#include "palpate/server/force_publisher.h"
#include "palpate/server/status_publisher.h"

namespace palpate::server {
namespace {

TEST(ForceOnTheWire, SaysWhatTheRecordSays) {
  ForceRecord record;
  record.tool_id = 2;
  record.seq = 11;
  record.pose_seq = 12;
  record.pose_stamp_ns = 13;
  record.stamp_ns = 14;
  record.wakeup_ns = 15;
  record.previous_tick_ns = 16;
  record.overruns = 17;
  record.superseded = 18;
  record.pose_wait_ns = 19;
  record.result.flags = kInContact | kForceLimited;
  record.result.state = static_cast<std::uint32_t>(ContactState::kStick);
  record.result.force = {1, 2, 3};
  record.result.stiffness = {1, 2, 3, 4, 5, 6, 7, 8, 9};
  record.result.anchor = {4, 5, 6};
  record.result.proxy = {7, 8, 9};
  record.result.displacement = {10, 11, 12};
  record.result.domain_radius = 0.004;
  record.result.penetration = 0.002;
  Facts facts;
  facts.server_id = 4;
  facts.session = 0xfedcba9876543210;
  record.model_hash = 0x0123456789abcdef;
  const dds::ToolForce force = toWire(facts, record);
  EXPECT_EQ(force.server_id, 4U);
  EXPECT_EQ(force.session, 0xfedcba9876543210);
  EXPECT_EQ(force.model_hash, 0x0123456789abcdefU);
  EXPECT_EQ(force.tool_id, 2U);
  EXPECT_EQ(force.seq, 11U);
  EXPECT_EQ(force.pose_seq, 12U);
  EXPECT_EQ(force.pose_stamp_ns, 13);
  EXPECT_EQ(force.stamp_ns, 14);
  EXPECT_EQ(force.wakeup_ns, 15);
  EXPECT_EQ(force.tick_ns, 16);
  EXPECT_EQ(force.overruns, 17U);
  EXPECT_EQ(force.superseded, 18U);
  EXPECT_EQ(force.pose_wait_ns, 19);
  EXPECT_EQ(force.flags, dds::flag::kInContact | dds::flag::kForceLimited);
  EXPECT_EQ(force.state, dds::tool_state::kStick);
  EXPECT_EQ(force.force[2], 3.0);
  EXPECT_EQ(force.torque[0], 0.0);
  EXPECT_EQ(force.stiffness[8], 9.0);
  EXPECT_EQ(force.anchor[0], 4.0);
  EXPECT_EQ(force.proxy[1], 8.0);
  EXPECT_EQ(force.displacement[2], 12.0);
  EXPECT_EQ(force.domain_radius, 0.004);
  EXPECT_EQ(force.penetration, 0.002);
}

TEST(StatusOnTheWire, SaysTimesInMicrosecondsAndCutsLongTexts) {
  Facts facts;
  facts.server_id = 3;
  facts.session = 5;
  facts.host = "bench";
  facts.pid = 77;
  facts.model_id = std::string(500, 'x');
  Health health;
  health.settings[3].tip_radius = 0.004;
  health.tick.add(2'000);
  health.last.phase = static_cast<std::uint32_t>(rt::PhaseState::kLocked);
  health.last.dropped = 2;
  health.failed_writes = 3;
  const dds::ServerStatus status = toWire(facts, health, dds::server_state::kRunning);
  EXPECT_EQ(status.server_id, 3U);
  EXPECT_EQ(status.session, 5U);
  EXPECT_TRUE(status.answers_any);
  EXPECT_STREQ(status.host, "bench");
  EXPECT_EQ(status.pid, 77U);
  EXPECT_EQ(status.tip_radius[3], 0.004);
  EXPECT_EQ(status.tick_us.p50, 2.0);
  EXPECT_EQ(status.tick_us.max, 2.0);
  EXPECT_EQ(status.tick_us.count, 1U);
  EXPECT_EQ(status.phase_lock, dds::phase::kLocked);
  EXPECT_EQ(status.dropped, 5U);
  EXPECT_EQ(std::string(status.model_id), std::string(sizeof status.model_id - 1, 'x'));
}

TEST(StatusOnTheWire, SaysWhyTicksWereLateAndWhoPreempted) {
  Health health;
  for (std::size_t i = 0; i < health.late.size(); ++i) health.late[i] = 10 + i;
  health.preempted_by = std::string(500, 'x');
  health.clock_steps = 3;
  health.clock_step_ns = -2'500'000'000;
  const dds::ServerStatus status = toWire({}, health, dds::server_state::kRunning);
  const auto count = [](rt::LateCause cause) { return 10 + static_cast<std::uint64_t>(cause); };
  EXPECT_EQ(status.late.unknown, count(rt::LateCause::kUnknown));
  EXPECT_EQ(status.late.own_work, count(rt::LateCause::kOwnWork));
  EXPECT_EQ(status.late.page_fault, count(rt::LateCause::kPageFault));
  EXPECT_EQ(status.late.preempted, count(rt::LateCause::kPreempted));
  EXPECT_EQ(status.late.stopped, count(rt::LateCause::kStopped));
  EXPECT_EQ(status.late.host_steal, count(rt::LateCause::kHostSteal));
  EXPECT_EQ(status.late.clock_step, count(rt::LateCause::kClockStep));
  EXPECT_EQ(std::string(status.late.preempted_by), std::string(95, 'x'));
  EXPECT_EQ(status.clock_steps, 3U);
  EXPECT_EQ(status.clock_step_s, -2.5);
}

TEST(StatusOnTheWire, TellsTheLastSecondAndMinuteBesideTheRun) {
  constexpr std::int64_t kSecond = 1'000'000'000;
  Health health;
  Times* const all[] = {&health.tick, &health.wakeup, &health.receive, &health.force_out};
  for (int second = 0; second < 3; ++second)
    for (int i = 0; i < 4; ++i) {
      all[i]->recent.goOn((second + 1) * kSecond);
      if (second < 2) all[i]->add(1000 * (10 * (i + 1) - second));
    }
  const dds::ServerStatus status = toWire({}, health, dds::server_state::kRunning);
  const std::pair<dds::Percentiles, dds::RecentTimes> told[] = {
      {status.tick_us, status.tick_recent_us},
      {status.wakeup_us, status.wakeup_recent_us},
      {status.receive_us, status.receive_recent_us},
      {status.force_out_us, status.force_out_recent_us}};
  for (int i = 0; i < 4; ++i) {
    EXPECT_EQ(told[i].first.max, 10.0 * (i + 1));
    EXPECT_EQ(told[i].second.minute.max, 10.0 * (i + 1));
    EXPECT_EQ(told[i].second.minute.count, 2U);
    EXPECT_EQ(told[i].second.second.max, 10.0 * (i + 1) - 1.0);
    EXPECT_EQ(told[i].second.second.count, 1U);
  }
}

TEST(StatusOnTheWire, PhasesAreThoseOfTheLock) {
  EXPECT_EQ(dds::phase::kOff, 0U);
  EXPECT_EQ(dds::phase::kFree, static_cast<std::uint32_t>(rt::PhaseState::kFree));
  EXPECT_EQ(dds::phase::kSeeking, static_cast<std::uint32_t>(rt::PhaseState::kSeeking));
  EXPECT_EQ(dds::phase::kLocked, static_cast<std::uint32_t>(rt::PhaseState::kLocked));
  EXPECT_EQ(dds::phase::kWaiting, static_cast<std::uint32_t>(rt::PhaseState::kWaiting));
}

TEST(StatusOnTheWire, SaysWhatTheHandFeels) {
  Facts facts;
  facts.device[0] = "omni";
  facts.organ = {160e3, 4200.0};
  facts.step.force_limit = 2.0;
  facts.step.friction = 0.25;
  facts.step.coupling_stiffness = 350.0;
  facts.step.coupling_damping = 0.75;
  facts.step.force_rate_limit = 900.0;
  facts.step.speed_limit = 1.5;
  facts.step.tools = 2;
  Health health;
  health.settings = toolSettings(facts.step);
  health.parameters_revision = 4;
  dds::ServerStatus status = toWire(facts, health, dds::server_state::kRunning);
  EXPECT_EQ(status.parameters_revision, 4U);
  EXPECT_STREQ(status.device, "omni");
  EXPECT_EQ(status.force_limit, 2.0);
  EXPECT_EQ(status.friction, 0.25);
  EXPECT_EQ(status.coupling_stiffness, 350.0);
  EXPECT_EQ(status.coupling_damping, 0.75);
  EXPECT_EQ(status.force_rate_limit, 900.0);
  EXPECT_EQ(status.speed_limit, 1.5);
  EXPECT_EQ(status.tools, 2U);
  EXPECT_EQ(status.youngs_modulus, 160e3) << "the model's own, none was asked for";
  health.settings[0].live.youngs_modulus = 5e3;
  status = toWire(facts, health, dds::server_state::kRunning);
  EXPECT_EQ(status.youngs_modulus, 5e3);
}

}  // namespace
}  // namespace palpate::server
