// SPDX-License-Identifier: Apache-2.0
// Which fields a tick hands over, and what is said of them. The test keeps the time.
#include <gtest/gtest.h>

#include "tick_fixture.h"

namespace palpate::server::testing {
namespace {

class TickFieldTest : public TickTest {
 protected:
  // Fields handed over in so many ticks, the tool at a depth in the first and so much deeper with each.
  int fieldsIn(int ticks, double depth, double deeper = 0.0) {
    int fields = 0;
    for (int i = 0; i < ticks; ++i) {
      send(poseAtDepth(0, depth + deeper * i));
      runOneTick();
      fields += channels_->surface.update() ? 1 : 0;
    }
    return fields;
  }
  static constexpr double kAbove = -0.01;
};

TEST_F(TickFieldTest, NobodyReadsSoNoneIsHandedOver) {
  channels_->field_readers = 0;
  EXPECT_EQ(fieldsIn(200, 0.0, 1e-5), 0);
  EXPECT_NE(takeFlags() & kInContact, 0U);
}

TEST_F(TickFieldTest, OfAnIdleToolOneASecondGoesOut) {
  (void)fieldsIn(200, kAbove);
  EXPECT_EQ(fieldsIn(10'000, kAbove), 10);
}

TEST_F(TickFieldTest, WhatChangesGoesOutWithEachTick) {
  EXPECT_EQ(fieldsIn(200, 0.0001, 1e-5), 200);
}

TEST_F(TickFieldTest, AfterTheLastChangeItGoesOutOnceMoreWithinATenthOfASecond) {
  (void)fieldsIn(200, 0.0001, 1e-5);
  (void)fieldsIn(1, 0.002);
  EXPECT_EQ(fieldsIn(100, 0.002), 1);
  EXPECT_EQ(fieldsIn(999, 0.002), 0);
  EXPECT_EQ(fieldsIn(1, 0.002), 1);
}

TEST_F(TickFieldTest, AReaderThatComesGetsAWholeFieldInTheNextTick) {
  (void)fieldsIn(500, kAbove);
  channels_->field_readers = 2;
  EXPECT_EQ(fieldsIn(1, kAbove), 1);
  EXPECT_EQ(fieldsIn(50, kAbove), 0);
}

TEST_F(TickFieldTest, NamesThePosesThatItBelongsTo) {
  send(poseAtDepth(2, 0.001));
  send(poseAtDepth(0, kAbove));
  const std::int64_t sent_ns = now_ns_;
  runOneTick();
  ASSERT_TRUE(channels_->surface.update());
  const SurfaceSample& sample = channels_->surface.front();
  EXPECT_EQ(sample.stamp_ns, now_ns_ + 7);
  EXPECT_EQ(sample.poses[2].seq, pose_seq_ - 1);
  EXPECT_EQ(sample.poses[0].seq, pose_seq_);
  EXPECT_EQ(sample.poses[0].stamp_ns, sent_ns);
  EXPECT_EQ(sample.poses[1].seq, 0U);
  EXPECT_EQ(sample.poses[1].stamp_ns, 0) << "it sent none";
}

TEST_F(TickFieldTest, OneThatOverflowedFlagsTheToolsInContact) {
  (void)fieldsIn(200, 0.0001, 1e-5);
  EXPECT_EQ(takeFlags() & kNonFiniteForce, 0U);
  channels_->field_overflowed = true;
  (void)fieldsIn(1, 0.002);
  EXPECT_NE(takeFlags() & kNonFiniteForce, 0U);
  (void)fieldsIn(1, kAbove);
  EXPECT_EQ(takeFlags() & kNonFiniteForce, 0U) << "it touches nothing";
}

TEST_F(TickFieldTest, ForcesAreTheSameWhoeverReads) {
  Engine unseen({std::shared_ptr<const void>{}, &model_}, StepConfig{});
  Channels nobody;
  PoseIntake intake(nobody, StepConfig{});
  Tick tick(unseen, nobody, {kPeriod});
  for (int i = 0; i < 300; ++i) {
    const dds::ToolPose pose = poseAtDepth(0, 0.003 * std::sin(0.03 * i));
    send(pose);
    intake.accept(pose, kSender, now_ns_);
    runOneTick();
    (void)tick.run(cycle_);
    ForceRecord seen, other;
    ASSERT_TRUE(channels_->forces.pop(seen) && nobody.forces.pop(other));
    ASSERT_EQ(seen.result.force, other.result.force) << i;
    ASSERT_EQ(seen.result.flags, other.result.flags) << i;
  }
}

}  // namespace
}  // namespace palpate::server::testing
