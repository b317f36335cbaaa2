// SPDX-License-Identifier: Apache-2.0
// The tick without its thread: the test keeps the time.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <map>
#include <memory>
#include <vector>

#include "core/tick/shown_surface.h"
#include "palpate/testing/allocation_guard.h"
#include "tick_fixture.h"

namespace palpate::server::testing {
namespace {

TEST_F(TickTest, AnswersNobodyBeforeTheFirstPose) {
  runOneTick();
  EXPECT_TRUE(takeForces().empty());
  EXPECT_TRUE(channels_->force_ready.tryWait());
  EXPECT_TRUE(channels_->surface.update()) << "the surface is there all the same";
}

TEST_F(TickTest, AnswersEveryToolThatWasSeenOnceATick) {
  send(poseAtDepth(2, 0.001));
  for (int i = 0; i < 5; ++i) runOneTick();
  send(poseAtDepth(0, -0.01));
  for (int i = 0; i < 3; ++i) runOneTick();
  std::uint64_t seq_of_0 = 0;
  std::uint64_t seq_of_2 = 0;
  for (const ForceRecord& record : takeForces()) {
    ASSERT_TRUE(record.tool_id == 0 || record.tool_id == 2);
    EXPECT_EQ(record.seq, record.tool_id == 0 ? ++seq_of_0 : ++seq_of_2);
    EXPECT_EQ(record.pose_seq, record.tool_id == 0 ? 2U : 1U);
    EXPECT_EQ(record.wakeup_ns, 7);
  }
  EXPECT_EQ(seq_of_0, 3U);
  EXPECT_EQ(seq_of_2, 8U);
}

TEST_F(TickTest, SaysHowLongThePoseHadWaited) {
  send(poseAtDepth(0, 0.001));
  const std::int64_t arrived_ns = now_ns_;
  for (int i = 0; i < 2; ++i) runOneTick();
  const auto forces = takeForces();
  ASSERT_EQ(forces.size(), 2U);
  for (const ForceRecord& record : forces) EXPECT_EQ(record.pose_wait_ns, record.stamp_ns - arrived_ns);
}

TEST_F(TickTest, PushesBackAndMovesTheSurface) {
  for (int i = 0; i < 100; ++i) {
    send(poseAtDepth(0, 0.00001 * i));
    runOneTick();
  }
  const ToolResult result = takeForces().back().result;
  EXPECT_GT(Eigen::Map<const Vec3>(result.force.data()).dot(normal_), 0.0);
  EXPECT_EQ(result.flags, kInContact);
  ASSERT_TRUE(channels_->surface.update());
  const SurfaceSample& frame = channels_->surface.front();
  EXPECT_EQ(frame.seq, 100U);
  EXPECT_EQ(frame.stamp_ns, now_ns_ + 7);
  EXPECT_TRUE(frame.state == work_.surface());
  ShownSurface surface(model_);
  EXPECT_TRUE(surface.show(frame.state));
  EXPECT_LT(std::ranges::min(surface.displacement()), -1e-4F);
}

TEST_F(TickTest, CountsPosesThatNoTickEverKnew) {
  send(poseAtDepth(0, -0.01));
  runOneTick();
  for (int i = 0; i < 4; ++i) send(poseAtDepth(0, -0.01));
  runOneTick();
  runOneTick();
  const auto forces = takeForces();
  EXPECT_EQ(forces[0].superseded, 0U);
  EXPECT_EQ(forces[1].superseded, 3U);
  EXPECT_EQ(forces[1].pose_seq, 5U);
  EXPECT_EQ(forces[2].superseded, 3U);
  EXPECT_EQ(takeLastRecord().superseded, 3U);
}

TEST_F(TickTest, CountsARejectedPoseOnceAndNotOnceATick) {
  dds::ToolPose pose = poseAtDepth(0, 0.001);
  pose.position[0] = std::numeric_limits<double>::quiet_NaN();
  send(pose);
  for (int i = 0; i < 5; ++i) runOneTick();
  EXPECT_EQ(takeLastRecord().rejected, 1U);
  EXPECT_NE(takeForces().front().result.flags & kNonFinitePose, 0U);
}

TEST_F(TickTest, FlagsAPoseThatWentBackwardsInTheTickThatUsesIt) {
  send(poseAtDepth(0, -0.01));
  dds::ToolPose early = poseAtDepth(0, -0.01);
  early.seq = 0;
  runOneTick();
  send(early);
  runOneTick();
  runOneTick();
  const auto forces = takeForces();
  EXPECT_EQ(forces[0].result.flags & kPoseOutOfOrder, 0U);
  EXPECT_NE(forces[1].result.flags & kPoseOutOfOrder, 0U);
  EXPECT_EQ(forces[2].result.flags & kPoseOutOfOrder, 0U);
  EXPECT_EQ(takeLastRecord().unordered, 1U);
}

TEST_F(TickTest, FlagsASecondPublisherForAsLongAsItSends) {
  const auto run = [&](int ticks, bool with_other) {
    for (int i = 0; i < ticks; ++i) {
      send(poseAtDepth(0, -0.01));
      if (with_other) intake_.accept(poseAtDepth(0, 0.003), kOther, now_ns_);
      runOneTick();
    }
    return takeForces();
  };
  EXPECT_EQ(run(20, false).back().result.flags & kTwoPublishers, 0U);
  EXPECT_EQ(run(1, true).back().result.flags & kTwoPublishers, 0U) << "the first one may have ended";
  const auto both = run(20, true);
  ASSERT_EQ(both.size(), 20U);
  for (const ForceRecord& record : both) {
    EXPECT_NE(record.result.flags & kTwoPublishers, 0U);
    EXPECT_EQ(record.result.flags & kInContact, 0U) << "the second one's pose was used";
    EXPECT_EQ(record.superseded, 0U);
  }
  EXPECT_EQ(run(60, false).back().result.flags & kTwoPublishers, 0U);
}

TEST_F(TickTest, AToolWhosePublisherIsGoneBeginsFromNothingWithTheNext) {
  for (int i = 0; i < 200; ++i) {
    send(poseAtDepth(0, 0.002));
    runOneTick();
  }
  const double pressed = Vec3(takeForces().back().result.force.data()).norm();
  ASSERT_GT(pressed, 0.1);
  (void)takeLastRecord();
  intake_.left(kSender);
  std::vector<double> forces;
  for (int i = 0; i < 100; ++i) {
    intake_.accept(poseAtDepth(0, 0.002), kOther, now_ns_);
    runOneTick();
    EXPECT_EQ(takeLastRecord().flags[0] & (kStalePose | kTwoPublishers), 0U) << "nothing to log";
    const auto records = takeForces();
    EXPECT_EQ(records.back().result.flags & (kStalePose | kTwoPublishers), 0U) << "nor for the new publisher";
    forces.push_back(Vec3(records.back().result.force.data()).norm());
  }
  EXPECT_EQ(forces[0], 0.0);
  EXPECT_LT(forces[1], 0.2 * pressed) << "it ramps";
  EXPECT_NEAR(forces.back(), pressed, 0.01 * pressed);
}

TEST_F(TickTest, FlagsTheFirstTickAfterMissedOnes) {
  send(poseAtDepth(0, -0.01));
  runOneTick();
  cycle_.overruns = 3;
  runOneTick();
  runOneTick();
  const auto forces = takeForces();
  EXPECT_EQ(forces[0].result.flags & kTickOverrun, 0U);
  EXPECT_NE(forces[1].result.flags & kTickOverrun, 0U);
  EXPECT_EQ(forces[2].result.flags & kTickOverrun, 0U);
}

TEST_F(TickTest, AnswersToolsThatGetNoForceInTurnAndOneATick) {
  for (std::uint32_t id = 4; id < 100; ++id) send(poseAtDepth(id, 0.001));
  for (int i = 0; i < 40; ++i) runOneTick();
  const auto forces = takeForces();
  ASSERT_EQ(forces.size(), 40U);
  std::map<std::uint32_t, std::uint64_t> seq;
  for (const ForceRecord& record : forces) {
    EXPECT_EQ(record.seq, ++seq[record.tool_id]);
    EXPECT_EQ(record.result.flags, kUnknownTool);
    EXPECT_EQ(record.result.force, (std::array<double, 3>{}));
  }
  EXPECT_EQ(seq.size(), kMaxUnknownTools);
  for (int i = 0; i < 20; ++i) runOneTick();
  (void)takeForces();
  runOneTick();
  EXPECT_TRUE(takeForces().empty()) << "no pose for 60 ms, no answer";
}

TEST_F(TickTest, AToolThatIsNotConfiguredGetsZeroForce) {
  StepConfig one;
  one.tools = 1;
  PoseIntake intake(*channels_, one);
  intake.accept(poseAtDepth(2, 0.003), kSender, now_ns_);
  runOneTick();
  const auto forces = takeForces();
  ASSERT_EQ(forces.size(), 1U);
  EXPECT_EQ(forces[0].tool_id, 2U);
  EXPECT_EQ(forces[0].result.flags, kToolNotConfigured);
  EXPECT_EQ(forces[0].result.force, (std::array<double, 3>{}));
  const TickRecord record = takeLastRecord();
  EXPECT_EQ(record.seen[2], 1);
  EXPECT_EQ(record.flags[2], kToolNotConfigured);
}

TEST_F(TickTest, AFullRingCostsTheNewestRecordAndTheCounterShowsIt) {
  send(poseAtDepth(0, -0.01));
  const std::size_t capacity = channels_->forces.capacity();
  for (std::size_t i = 0; i < capacity + 3; ++i) runOneTick();
  EXPECT_EQ(takeForces().back().seq, capacity);
  EXPECT_EQ(takeLastRecord().dropped, 3U);
  runOneTick();
  EXPECT_EQ(takeForces().back().seq, capacity + 4) << "the receiver sees a gap of three";
}

TEST_F(TickTest, AFullRecordingRingCostsTheNewestTicksAndTheCounterShowsIt) {
  channels_->recording = std::make_unique<rt::SpscQueue<SessionTick, 16384>>();
  send(poseAtDepth(0, -0.01));
  for (std::size_t i = 0; i < channels_->recording->capacity() + 3; ++i) runOneTick();
  EXPECT_EQ(channels_->unrecorded, 3U);
  SessionTick first;
  ASSERT_TRUE(channels_->recording->pop(first));
  const record::RecordedTick& tick = first.tick;
  EXPECT_EQ(tick.index, 0U);
  EXPECT_EQ(tick.input.tools[0].present, 1U);
  EXPECT_EQ(tick.input.dt_ns, 0);
  EXPECT_EQ(first.unrecorded, 0U);
  runOneTick();
  SessionTick newest;
  while (channels_->recording->pop(newest)) {
  }
  EXPECT_EQ(newest.unrecorded, 3U) << "the first that came after the gap";
}

TEST_F(TickTest, RecordsWhenAPoseWasSentWhenItCameAndItsButtons) {
  channels_->recording = std::make_unique<rt::SpscQueue<SessionTick, 16384>>();
  dds::ToolPose pose = poseAtDepth(2, -0.01);
  pose.stamp_ns = -5;  // a clock of its own
  pose.buttons = 6;
  const std::int64_t arrival_ns = now_ns_;
  send(pose);
  runOneTick();
  runOneTick();
  SessionTick newest;
  const record::RecordedTick& tick = newest.tick;
  for (int i = 0; i < 2; ++i) {
    ASSERT_TRUE(channels_->recording->pop(newest));
    EXPECT_EQ(tick.poses[2], (record::PoseFacts{pose.seq, -5, arrival_ns, 6}));
    EXPECT_EQ(tick.poses[0], record::PoseFacts{}) << "no pose has come";
  }
  EXPECT_EQ(tick.woke_ns, cycle_.woke_ns);
}

TEST_F(TickTest, WritesTheSurfaceAsOftenAsAskedInTheMeanAndTheForceEveryTick) {
  Tick seldom(engine_, *channels_, {kPeriod, 16'666'667});  // 60 Hz: no whole number of ticks
  std::int64_t last_ns = 0;
  SurfaceState last;
  for (int i = 0; i < 1000; ++i) {
    send(poseAtDepth(0, 0.000001 * i));
    now_ns_ += kPeriod;
    cycle_.deadline_ns = cycle_.woke_ns = now_ns_;
    (void)seldom.run(cycle_);
    ++cycle_.index;
    EXPECT_EQ(takeForces().size(), 1U);
    if (!channels_->surface.update()) continue;
    const SurfaceSample& frame = channels_->surface.front();
    if (last_ns != 0) {
      EXPECT_NEAR(static_cast<double>(frame.stamp_ns - last_ns), 16.5e6, 0.5e6);
      EXPECT_FALSE(frame.state == last);
    }
    last = frame.state;
    last_ns = frame.stamp_ns;
  }
  EXPECT_EQ(channels_->surface.front().seq, 60U);
}

TEST_F(TickTest, AfterAStallTheSurfaceIsNotWrittenInABunch) {
  Tick seldom(engine_, *channels_, {kPeriod, 10 * kPeriod});
  double depth = 0.001;
  const auto run = [&](int ticks) {
    for (int i = 0; i < ticks; ++i, now_ns_ += kPeriod, depth += 1e-5) {
      send(poseAtDepth(0, depth));
      cycle_.deadline_ns = cycle_.woke_ns = now_ns_;
      (void)seldom.run(cycle_);
    }
    (void)channels_->surface.update();
    return channels_->surface.front().seq;
  };
  EXPECT_EQ(run(20), 2U);
  now_ns_ += 500 * kPeriod;
  EXPECT_EQ(run(20), 4U);
}

TEST_F(TickTest, AllocatesNothingWhateverComes) {
  channels_->recording = std::make_unique<rt::SpscQueue<SessionTick, 16384>>();
  dds::ToolPose bad = poseAtDepth(1, 0.001);
  bad.position[2] = std::numeric_limits<double>::infinity();
  std::vector<dds::ToolPose> poses;
  for (int i = 0; i < 100; ++i)
    poses.push_back(poseAtDepth(static_cast<std::uint32_t>(i % 6), 0.0003 * (i - 10)));
  std::uint32_t flags = 0;
  const palpate::testing::AllocationGuard guard;
  for (const dds::ToolPose& pose :
       poses) {  // approach, contact of four tools, beyond the domain, unknown tools
    send(pose);
    runOneTick();
    flags |= takeFlags();
  }
  send(bad);
  for (int i = 0; i < 100; ++i, flags |= takeFlags()) runOneTick();  // not finite, then stale
  for (int i = 99; i >= 0; --i) {                                    // and out again, backwards in order
    send(poses[static_cast<std::size_t>(i)]);
    runOneTick();
    flags |= takeFlags();
  }
  channels_->shutting_down = true;
  for (int i = 0; i < 500; ++i) runOneTick();  // until every ring is full
  flags |= takeFlags();
  EXPECT_EQ(guard.count(), 0U);
  const std::uint32_t wanted =
      kInContact | kBeyondDomain | kNonFinitePose | kStalePose | kRamping | kPoseOutOfOrder | kShuttingDown;
  EXPECT_EQ(flags & wanted, wanted) << "the ticks above did not go where they should";
}

}  // namespace
}  // namespace palpate::server::testing
