// SPDX-License-Identifier: Apache-2.0
#include "core/tick/continuity.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>

namespace palpate::testing {

namespace {

constexpr std::int64_t kMs = 1'000'000;  // ns

/// Poses of one tool, a millisecond each; its contact does what the test says.
class Track {
 public:
  Contact contact;
  StepInput input;

  /// @param x  m, @param age_ns  of the pose
  PoseJudgement judge(double x, std::int64_t age_ns = 0) {
    tool_.present = 1;
    tool_.position = {x, 0.0, 0.0};
    tool_.age_ns = age_ns;
    return continuity_.judge(tool_, TickTime(input), config_);
  }
  /// A tick that gives a force. @return what it does not follow from
  std::uint32_t causes(double x = 0.0, bool others_jumped = false) {
    judge(x);
    const std::uint32_t causes = continuity_.take(contact, others_jumped, config_);
    continuity_.end(tool_, true, TickTime(input), config_);
    return causes;
  }
  /// Ticks without a good pose.
  void miss(int ticks) {
    tool_.present = 0;
    for (int i = 0; i < ticks; ++i) continuity_.end(tool_, false, TickTime(input), config_);
  }
  Continuity& continuity() { return continuity_; }

 private:
  StepConfig config_;
  ToolInput tool_;
  Continuity continuity_;
};

}  // namespace

TEST(Continuity, OnlyTheFirstForceBeginsFromZero) {
  Track track;
  EXPECT_FALSE(track.continuity().known());
  EXPECT_EQ(track.causes(), kFirstPose);
  EXPECT_EQ(track.causes(), 0U);
}

TEST(Continuity, APoseComesBackAfterTheStaleTimeout) {
  Track track;
  track.causes();
  track.miss(19);
  EXPECT_EQ(track.causes(), 0U);
  track.miss(21);
  EXPECT_EQ(track.causes(), kPoseCameBack);
}

TEST(Continuity, ALeapIsJudgedByTheTimeBetweenThePoses) {
  Track track;
  EXPECT_EQ(track.judge(1.0).way, TipWay::kStraight) << "of the first pose no way is known";
  track.causes(0.0);
  EXPECT_EQ(track.judge(0.007).way, TipWay::kNone) << "more than 2 m/s times 1 ms and 2 ms of unevenness";
  track.causes(0.0);
  track.miss(3);
  EXPECT_EQ(track.judge(0.007).way, TipWay::kStraight);
}

TEST(Continuity, AWayIsUnseenAfterTheStaleTimeoutAndAnUnevenPeriod) {
  Track track;
  track.causes();
  track.miss(21);
  EXPECT_EQ(track.judge(0.0).way, TipWay::kStraight);
  track.miss(3);
  EXPECT_EQ(track.judge(0.0).way, TipWay::kUnseen);
}

TEST(Continuity, ADiscontinuityWaitsForTheNextForce) {
  Track track;
  track.causes();
  track.continuity().disturb(kLoopStoodStill);
  track.miss(1);
  track.continuity().disturb(kParameterSwitched);
  EXPECT_EQ(track.causes(), kLoopStoodStill | kParameterSwitched);
  EXPECT_EQ(track.causes(), 0U);
}

TEST(Continuity, TheJumpOfAnotherToolIsFeltInContactOnly) {
  Track track;
  track.causes();
  EXPECT_EQ(track.causes(0.0, true), 0U);
  track.contact.state = ContactState::kStick;
  EXPECT_EQ(track.causes(0.0, true), kOthersJumped);
  track.contact.jump = ContactJump::kSnapped;
  EXPECT_EQ(track.causes(0.0, true), kContactJumped | kOthersJumped);
}

TEST(Continuity, AStalePoseIsNotUsable) {
  Track track;
  EXPECT_TRUE(track.judge(0.0, 20 * kMs).usable);
  EXPECT_FALSE(track.judge(0.0, 20 * kMs + 1).usable);
  EXPECT_FALSE(track.judge(2000.0).usable);
  EXPECT_EQ(track.judge(2000.0).flags, kNonFinitePose);
}

TEST(Continuity, ALoopStoodStillAfterTenPeriodsAndTenMilliseconds) {
  StepInput input;
  for (const std::int64_t period : {kMs / 10, kMs, 4 * kMs}) {
    const std::int64_t longest = std::max(10 * period, 10 * kMs);
    input.period_ns = period;
    input.dt_ns = longest;
    EXPECT_FALSE(TickTime(input).stood_still) << period;
    input.dt_ns = longest + 1000;
    EXPECT_TRUE(TickTime(input).stood_still) << period;
    EXPECT_DOUBLE_EQ(TickTime(input).ramp, 2e-9 * static_cast<double>(period));
  }
}

}  // namespace palpate::testing
