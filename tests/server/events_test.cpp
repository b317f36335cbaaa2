// SPDX-License-Identifier: Apache-2.0
#include "palpate/server/events.h"

#include <gtest/gtest.h>
#include <spdlog/sinks/ostream_sink.h>
#include <spdlog/spdlog.h>

#include <array>
#include <chrono>
#include <memory>
#include <sstream>
#include <thread>
#include <vector>

#include "palpate/testing/test_domain.h"

namespace palpate::server {
namespace {

constexpr std::int64_t kLoggedSecond = 1'000'000'000;

class EventsTest : public ::testing::Test {
 protected:
  EventsTest() {
    auto sink = std::make_shared<spdlog::sinks::ostream_sink_st>(log_);
    sink->set_pattern("%v");
    spdlog::set_default_logger(std::make_shared<spdlog::logger>("test", std::move(sink)));
  }
  ~EventsTest() override { spdlog::set_default_logger(std::make_shared<spdlog::logger>("none")); }

  std::string takeLog() {
    const std::string text = log_.str();
    log_.str("");
    return text;
  }

  std::ostringstream log_;
  std::unique_ptr<Channels> channels_ = std::make_unique<Channels>();
  Facts facts_;
  dds::Participant participant_{palpate::testing::exclusiveDomain()};
  StatusPublisher status_{participant_, facts_};
  ParameterService parameters_{participant_, *channels_, facts_};
  RivalWatch rivals_{participant_, facts_, status_, 0.0};
  Events events_{*channels_, status_, parameters_, rivals_};
};

TEST_F(EventsTest, GathersTheTimesOfEveryTick) {
  for (std::uint64_t tick = 1; tick <= 100; ++tick) {
    TickRecord record;
    record.ticks = tick;
    record.wakeup_ns = 10;
    record.previous_tick_ns = tick == 1 ? 0 : 50;
    ASSERT_TRUE(channels_->ticks.push(record));
  }
  events_.drain(0);
  EXPECT_EQ(events_.health().wakeup.run.count(), 100U);
  EXPECT_EQ(events_.health().tick.run.count(), 99U) << "the first tick has none before it";
  EXPECT_EQ(events_.health().tick.run.quantile(0.0), 50);
  EXPECT_EQ(events_.health().last.ticks, 100U);
}

TEST_F(EventsTest, CountsLateTicksByCauseAndTellsOfThoseThatMissedAPeriod) {
  LateTick late{700'000, 0, rt::LateCause::kHostSteal, {}};
  ASSERT_TRUE(channels_->late_ticks.push(late));
  events_.drain(kLoggedSecond);
  EXPECT_EQ(takeLog(), "") << "no period was missed";
  late = {5'100'000, 5, rt::LateCause::kPreempted, {'h', 'o', 'g', ' ', '(', '7', ')'}};
  ASSERT_TRUE(channels_->late_ticks.push(late));
  late = {5'200'000, 5, rt::LateCause::kUnknown, {}};
  ASSERT_TRUE(channels_->late_ticks.push(late));
  channels_->unjudged = 2;
  events_.drain(2 * kLoggedSecond);
  EXPECT_EQ(takeLog(), "a tick ended 5100 us after it was due: preempted by hog (7)\n");
  const Health& health = events_.health();
  EXPECT_EQ(health.late[static_cast<std::size_t>(rt::LateCause::kHostSteal)], 1U);
  EXPECT_EQ(health.late[static_cast<std::size_t>(rt::LateCause::kPreempted)], 1U);
  EXPECT_EQ(health.late[static_cast<std::size_t>(rt::LateCause::kUnknown)], 3U);
  EXPECT_EQ(health.preempted_by, "hog (7)");
  ASSERT_TRUE(channels_->late_ticks.push(late));
  events_.drain(4 * kLoggedSecond);
  EXPECT_EQ(takeLog(), "a tick ended 5200 us after it was due: cause unknown\n");
}

TEST_F(EventsTest, TellsThatTheWallClockWasSet) {
  channels_->clock_steps = 1;
  channels_->clock_step_ns = 2'000'000'000;
  events_.drain(kLoggedSecond);
  EXPECT_EQ(
      takeLog(),
      "the machine's wall clock was set by 2.000000 s: no tick depends on it, stamps taken from it jump\n");
  events_.drain(3 * kLoggedSecond);
  EXPECT_EQ(takeLog(), "");
}

TEST_F(EventsTest, GathersWhatReceivingAndSendingTook) {
  ASSERT_TRUE(channels_->receive_delays.push(40'000));
  ASSERT_TRUE(channels_->force_delays.push(60'000));
  ASSERT_TRUE(channels_->force_delays.push(70'000));
  events_.drain(kLoggedSecond);
  EXPECT_EQ(events_.health().receive.run.max(), 40'000);
  EXPECT_EQ(events_.health().force_out.run.count(), 2U);
  EXPECT_EQ(events_.health().force_out.recent.second().count(), 0U) << "the second is not over";
  events_.drain(2 * kLoggedSecond);
  EXPECT_EQ(events_.health().force_out.recent.second().max(), 70'000);
}

TEST_F(EventsTest, TellsWhereThePhaseCameToAndNotTheWayThere) {
  const auto come = [&](rt::PhaseState state, std::int64_t now_ns) {
    TickRecord record;
    record.phase = static_cast<std::uint32_t>(state);
    ASSERT_TRUE(channels_->ticks.push(record));
    events_.drain(now_ns);
  };
  come(rt::PhaseState::kFree, kLoggedSecond);
  come(rt::PhaseState::kSeeking, kLoggedSecond);
  EXPECT_EQ(takeLog(), "");
  come(rt::PhaseState::kLocked, kLoggedSecond + 1);
  come(rt::PhaseState::kSeeking, kLoggedSecond + 2);
  come(rt::PhaseState::kLocked, kLoggedSecond + 3);
  EXPECT_EQ(takeLog(), "phase lock: ticks follow the poses\n");
  come(rt::PhaseState::kFree, 3 * kLoggedSecond);
  EXPECT_EQ(takeLog(),
            "phase lock: no poses to follow, or none with a phase of their own: ticks keep their phase\n");
}

TEST_F(EventsTest, AFlagIsLoggedWhenItBeginsAndAtMostOnceASecond) {
  TickRecord record;
  record.seen[1] = 1;
  const auto flick = [&](std::int64_t now_ns) {
    record.flags[1] = kBeyondDomain | kInContact;
    ASSERT_TRUE(channels_->ticks.push(record));
    record.flags[1] = 0;
    ASSERT_TRUE(channels_->ticks.push(record));
    events_.drain(now_ns);
  };
  const std::string warning = "tool 1: pressed beyond the model's domain\n";
  flick(kLoggedSecond);
  EXPECT_EQ(takeLog(), "tool 1: first pose\n" + warning);
  flick(kLoggedSecond + 1);
  EXPECT_EQ(takeLog(), "");
  flick(3 * kLoggedSecond);
  EXPECT_EQ(takeLog(), warning);
  EXPECT_EQ(events_.health().recent_flags, kBeyondDomain | kInContact);
}

TEST_F(EventsTest, AReleaseIsNoFaultAndAHandThatLosesItsForceIs) {
  TickRecord record;
  record.seen[3] = 1;
  const auto tick = [&](std::uint32_t flags, std::int64_t now_ns) {
    record.flags[3] = flags;
    ASSERT_TRUE(channels_->ticks.push(record));
    events_.drain(now_ns);
  };
  tick(kInContact, kLoggedSecond);
  tick(0, kLoggedSecond);
  (void)takeLog();
  tick(kStalePose, kLoggedSecond);  // lifted off, then no more poses
  EXPECT_EQ(takeLog(), "tool 3: its poses ended while it touched nothing\n");
  tick(kStalePose, 2 * kLoggedSecond);
  tick(0, 3 * kLoggedSecond);
  EXPECT_EQ(takeLog(), "") << "for as long as nobody holds it";
  tick(kInContact, 4 * kLoggedSecond);
  tick(kInContact | kStalePose | kRamping, 5 * kLoggedSecond);  // a driver that ended while it pressed
  EXPECT_EQ(takeLog(), "tool 3: no good pose for the stale timeout: force ramps to zero\n");
}

TEST_F(EventsTest, MissedTicksLostRecordsAndUnknownToolsAreLogged) {
  TickRecord record;
  record.overruns = 3;
  record.dropped = 2;
  ASSERT_TRUE(channels_->ticks.push(record));
  channels_->unknown_poses = 1;
  channels_->unknown_id = 9;
  channels_->failed_writes = 4;
  events_.drain(kLoggedSecond);
  const std::string log = takeLog();
  EXPECT_EQ(log,
            "ticks missed (3 so far)\n"
            "a ring was full (2 records lost so far)\n"
            "pose of tool 9: tool ids are 0 to 3, no force (1 so far)\n"
            "DDS refused to send (4 so far)\n");
  EXPECT_EQ(events_.health().unknown_tools, 1U);
  EXPECT_EQ(events_.health().recent_flags, kUnknownTool);
  EXPECT_EQ(events_.health().failed_writes, 4U);
}

TEST_F(EventsTest, ARequestIsAnsweredHandedToTheTickAndLoggedWhenItChangesSomething) {
  dds::Writer<dds::ParameterRequest> requests(participant_);
  const dds::Reader<dds::ServerParameters> answers(participant_);
  ASSERT_TRUE(requests.waitForReaders(1, std::chrono::seconds(5)));
  ASSERT_TRUE(answers.waitForWriters(1, std::chrono::seconds(5)));
  std::vector<dds::ServerParameters> got;
  std::int64_t now_ns = kLoggedSecond;
  const auto ask = [&](std::uint32_t fields, double friction) {
    dds::ParameterRequest request{};
    request.request_id = got.size() + 1;
    request.fields = fields;
    request.friction = friction;
    (void)requests.write(request);
    dds::ServerParameters answer{};
    for (int i = 0; i < 1000; ++i) {
      events_.drain(now_ns);
      std::array<dds::ServerParameters, dds::kMaxTake> some;
      const std::size_t count = answers.take(some);
      for (std::size_t k = 0; k < count; ++k) answer = some[k];
      if (answer.request_id == request.request_id) break;
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    now_ns += 2 * kLoggedSecond;
    got.push_back(answer);
  };
  ask(0, 0.0);
  EXPECT_EQ(takeLog(), "") << "a question is no news";
  ask(dds::parameter::kFriction, 3.0);
  EXPECT_EQ(takeLog().find("parameters refused: friction is 3"), 0U);
  AllToolSettings settings;
  EXPECT_FALSE(channels_->parameters.read(settings));
  ask(dds::parameter::kFriction, 0.2);
  EXPECT_EQ(takeLog().find("parameters, revision 1: "), 0U);
  EXPECT_TRUE(channels_->parameters.read(settings));
  EXPECT_EQ(settings[0].live.friction, 0.2);
  EXPECT_EQ(events_.health().settings[0].live.friction, 0.2);
  EXPECT_EQ(events_.health().parameters_revision, 1U);
  ASSERT_EQ(got.size(), 3U);
  EXPECT_TRUE(got[0].accepted);
  EXPECT_FALSE(got[1].accepted);
  EXPECT_EQ(got[2].tools[0].now.friction, 0.2);
}

}  // namespace
}  // namespace palpate::server
