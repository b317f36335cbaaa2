// SPDX-License-Identifier: Apache-2.0
#include "force_renderer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "palpate_haptic_flags.h"

namespace palpate::haptic {
namespace {

constexpr std::int64_t kMs = 1'000'000;
constexpr double kNoLimit = 1000.0;

double sizeOf(const Vec3& v) {
  return std::hypot(v[0], v[1], v[2]);
}

// A tool 1 mm deep in a plane z = 0 of 500 N/m, 200 N/m sideways; answered at its pose, with the watchdog at full gain.
class Pressed : public ::testing::Test {
 protected:
  void SetUp() override {
    renderer.sent(7, kPose, now);
    answer.force = {0.1, 0.0, 0.5};
    answer.stiffness = {-200, 0, 0, 0, -200, 0, 0, 0, -500};
    answer.pose_seq = 7;
    fresh(answer);
  }
  // The answer comes again and again until the ramp is over.
  void fresh(Answer a) {
    for (int i = 0; i < 40; ++i) {
      a.arrived_ns = now += kMs;
      ASSERT_TRUE(renderer.answered(a));
      (void)renderer.at(nullptr, now, kNoLimit);
    }
  }
  Vec3 at(const Point& p, double limit = kNoLimit) { return renderer.at(&p, now, limit).force; }

  const Point kPose{0.0, 0.0, -0.001};
  ForceRenderer renderer{0.002};
  Answer answer;
  std::int64_t now{1000 * kMs};
};

TEST(ForceRendererNearest, IsOfAFreeToolTheDistanceToItsAnchor) {
  ForceRenderer renderer{0.002};
  EXPECT_EQ(renderer.nearest(), std::numeric_limits<double>::infinity());
  Answer answer;
  const auto answered = [&](std::uint64_t seq, const Point& position, const Vec3& anchor) {
    renderer.sent(seq, position, 0);
    answer.pose_seq = seq;
    answer.anchor = anchor;
    ASSERT_TRUE(renderer.answered(answer));
  };
  answered(1, {0.0, 0.0, 60.0}, {0.0, 0.0, 0.05});
  EXPECT_DOUBLE_EQ(renderer.nearest(), 59.95);
  answered(2, {0.0, 0.03, 0.09}, {0.0, 0.0, 0.05});
  EXPECT_DOUBLE_EQ(renderer.nearest(), 0.05);
  answered(3, {0.0, 0.0, 60.0}, {0.0, 0.0, 0.05});
  EXPECT_DOUBLE_EQ(renderer.nearest(), 0.05) << "the nearest so far";
  answer.pose_seq = 1 + 1024 + 3;  // a pose that was not sent
  answer.anchor = {0.0, 0.0, 60.0};
  ASSERT_TRUE(renderer.answered(answer));
  EXPECT_DOUBLE_EQ(renderer.nearest(), 0.05);
  for (const std::uint32_t not_used :
       {PALPATE_HAPTIC_FLAG_TOOL_NOT_CONFIGURED, PALPATE_HAPTIC_FLAG_UNKNOWN_TOOL,
        PALPATE_HAPTIC_FLAG_NON_FINITE_POSE}) {
    answer.flags = not_used;
    answered(1050, {0.0, 0.0, 0.01}, {0.0, 0.0, 0.0});
    EXPECT_DOUBLE_EQ(renderer.nearest(), 0.05) << "its anchor is no place";
  }
  answer.flags = 0;
  answer.state = 1;
  answered(1100, {0.0, 0.0, 0.07}, {0.0, 0.0, 0.05});
  EXPECT_EQ(renderer.nearest(), 0.0) << "a contact";
}

// The server went on answering meanwhile, and so did the kernel for the driver: the first answers are as old as the pause.
TEST_F(Pressed, ComesBackAfterADriverThatDidNotReadOnceALaterPoseIsAnswered) {
  EXPECT_EQ(renderer.at(nullptr, now, kNoLimit).gain, 1.0);
  now += 1000 * kMs;
  renderer.sent(8, kPose, now);  // just before the pause, or after it
  for (int ms = 0; ms < 10; ++ms) {
    answer.arrived_ns = now += kMs;
    answer.pose_seq = ms < 5 ? 7 : 8;
    ASSERT_TRUE(renderer.answered(answer));
    EXPECT_EQ(renderer.at(nullptr, now, kNoLimit).gain, 0.0) << ms;
    renderer.sent(9 + static_cast<std::uint64_t>(ms), kPose, now);
  }
  answer.pose_seq = 9;
  double last = 0.0;
  for (int ms = 0; ms < 40; ++ms) {
    answer.arrived_ns = now += kMs;
    ASSERT_TRUE(renderer.answered(answer));
    const double gain = renderer.at(nullptr, now, kNoLimit).gain;
    EXPECT_LE(gain, last + 1.0 / 30.0 + 1e-9);
    last = gain;
  }
  EXPECT_EQ(last, 1.0);
}

TEST_F(Pressed, FallsWithAShortPauseOfTheDriverAndComesBackByARamp) {
  answer.arrived_ns = now += 35 * kMs;
  ASSERT_TRUE(renderer.answered(answer));
  EXPECT_NEAR(renderer.at(nullptr, now, kNoLimit).gain, 0.5 + 5.0 / 30.0, 1e-9);
  answer.arrived_ns = now += kMs;
  ASSERT_TRUE(renderer.answered(answer));
  EXPECT_NEAR(renderer.at(nullptr, now, kNoLimit).gain, 0.5 + 6.0 / 30.0, 1e-9);
}

TEST_F(Pressed, IsHeldWithoutAPosition) {
  EXPECT_EQ(renderer.at(nullptr, now, kNoLimit).force, answer.force);
  EXPECT_EQ(at(kPose), answer.force);
}

TEST_F(Pressed, FollowsTheStiffnessFromTheAnsweredPose) {
  const Vec3 deeper = at({0.0001, 0.0, -0.0015});
  EXPECT_NEAR(deeper[0], 0.1 - 0.02, 1e-12);
  EXPECT_NEAR(deeper[2], 0.5 + 0.25, 1e-12);
}

TEST_F(Pressed, GoesNoFartherThanTheBound) {
  const Vec3 far = at({0.0, 0.0, -0.5});
  EXPECT_NEAR(far[2], 0.5 + 500.0 * 0.002, 1e-12);
  EXPECT_EQ(far, at({0.0, 0.0, -0.4}));
}

TEST_F(Pressed, NeverPullsWhereItPushed) {
  for (double z = -0.001; z < 0.003; z += 1e-5) {
    const Vec3 f = at({0.0, 0.0, z});
    EXPECT_GE(f[0] * answer.force[0] + f[2] * answer.force[2], -1e-12) << z;
  }
}

TEST_F(Pressed, NeverPushesAlongTheWay) {
  answer.stiffness = {300, 0, 0, 0, 300, 0, 0, 0, -500};  // sideways it would run away
  fresh(answer);
  EXPECT_NEAR(at({0.0005, 0.0, -0.001})[0], 0.1, 1e-12);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> entry(-800.0, 800.0), part(-0.001, 0.001);
  for (int i = 0; i < 2000; ++i) {
    for (double& s : answer.stiffness) s = entry(random);
    answer.arrived_ns = now;
    ASSERT_TRUE(renderer.answered(answer));
    const Point way{part(random), part(random), part(random)};
    const Vec3 f = at(kPose + way);
    const Point change{f[0] - answer.force[0], f[1] - answer.force[1], f[2] - answer.force[2]};
    const bool was_clipped_from_pulling = f[0] * answer.force[0] + f[2] * answer.force[2] < 1e-9;
    EXPECT_TRUE(was_clipped_from_pulling || dot(change, way) <= 1e-12);
  }
}

TEST_F(Pressed, IsContinuousInThePosition) {
  const double step = 1e-6;  // m
  const Point start{-0.004, 0.001, -0.006}, way{0.7, -0.3, 0.648};
  Vec3 before = at(start);
  for (int i = 1; i < 12000; ++i) {
    const Vec3 f = at(start + (i * step) * way);
    const double jump = std::hypot(f[0] - before[0], f[1] - before[1], f[2] - before[2]);
    ASSERT_LE(jump, 2.0 * 500.0 * step) << i;
    before = f;
  }
}

TEST_F(Pressed, IsNeverLongerThanTheLimit) {
  EXPECT_NEAR(sizeOf(at({0.0, 0.0, -0.003}, 0.6)), 0.6, 1e-12);
  EXPECT_NEAR(sizeOf(renderer.at(nullptr, now, 0.2).force), 0.2, 1e-12);
}

TEST_F(Pressed, StartsFromThePoseThatWasAnswered) {
  for (std::uint64_t seq = 8; seq < 12; ++seq)
    renderer.sent(seq, {0, 0, -0.001 - 1e-4 * static_cast<double>(seq)}, now);
  EXPECT_EQ(at(kPose), answer.force) << "poses sent since do not matter";
  answer.pose_seq = 9;
  answer.arrived_ns = now;
  ASSERT_TRUE(renderer.answered(answer));
  EXPECT_NEAR(at({0, 0, -0.0019})[2], 0.5, 1e-12);
  EXPECT_NEAR(at(kPose)[2], 0.5 - 500.0 * 0.0009, 1e-12);
}

TEST_F(Pressed, IsHeldWhenTheAnsweredPoseIsForgotten) {
  for (std::uint64_t seq = 8; seq < 8 + ForceRenderer::kPoses; ++seq) renderer.sent(seq, kPose, now);
  EXPECT_EQ(at({0, 0, -0.002}), answer.force);
}

TEST_F(Pressed, IsHeldAtAPositionThatIsNoNumber) {
  EXPECT_EQ(at({NAN, 0, 0}), answer.force);
  EXPECT_EQ(at({0, std::numeric_limits<double>::infinity(), 0}), answer.force);
}

TEST_F(Pressed, LeavesOutWhatIsNoNumberOrOlder) {
  Answer bad = answer;
  bad.force[1] = NAN;
  EXPECT_FALSE(renderer.answered(bad));
  bad = answer;
  bad.stiffness[8] = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(renderer.answered(bad));
  bad = answer;
  bad.pose_seq = 6;
  EXPECT_FALSE(renderer.answered(bad));
  EXPECT_EQ(at(kPose), answer.force);
}

// What is read is rendered until the next read: the force that a device renders 50 ms after an answer is the one it read before.
TEST_F(Pressed, IsGoneAtTheDevice50MsAfterTheAnswer) {
  for (const std::int64_t period : {kMs / 4, kMs, 4 * kMs}) {
    fresh(answer);
    const std::int64_t start = now;
    for (; now + period < start + 50 * kMs; now += period) {
      const double until = 1e-6 * static_cast<double>(now + period - start);  // ms, rendered until then
      const double gain = now > start ? renderer.at(nullptr, now, kNoLimit).gain : 1.0;
      EXPECT_NEAR(gain, std::min(1.0, 1.0 - (until - 20.0) / 30.0), 1e-9) << until;
    }
    EXPECT_NEAR(renderer.at(nullptr, now, kNoLimit).gain, 0.0, 1e-9) << "at 50 ms, period " << period;
  }
  now += 30 * kMs;
  EXPECT_EQ(sizeOf(renderer.at(nullptr, now, kNoLimit).force), 0.0);
}

TEST_F(Pressed, TellsTheAgeOfItsAnswer) {
  EXPECT_NEAR(renderer.at(nullptr, now + 80 * kMs, kNoLimit).age_s, 0.080, 1e-12);
}

TEST_F(Pressed, ComesBackWithin30MsAndNeverAtOnce) {
  for (int ms = 0; ms < 100; ++ms) (void)renderer.at(nullptr, now += kMs, kNoLimit);
  double before = 0.0;
  for (int ms = 1; ms <= 30; ++ms) {
    answer.arrived_ns = now += kMs;
    ASSERT_TRUE(renderer.answered(answer));
    const double gain = renderer.at(nullptr, now, kNoLimit).gain;
    EXPECT_LE(gain - before, 1.0 / 30.0 + 1e-9);
    before = gain;
  }
  EXPECT_NEAR(before, 1.0, 1e-9);
}

// A network that delays by so many ms: answers come at their pace, each to a pose of so long ago; and the gain in the end.
class Delayed : public Pressed, public ::testing::WithParamInterface<std::pair<int, double>> {};

TEST_P(Delayed, AnswersThatArriveMoreThan50MsAfterTheirPoseAreIgnored) {
  const auto [delay_ms, gain] = GetParam();
  constexpr int kMost = 2 * static_cast<int>(ForceRenderer::kPoses);
  for (int ms = 0; ms < kMost; ++ms) {
    now += kMs;
    renderer.sent(8 + static_cast<std::uint64_t>(ms), kPose, now);
    if (ms >= delay_ms) {
      answer.pose_seq = 8 + static_cast<std::uint64_t>(ms - delay_ms);
      answer.arrived_ns = answer.first_arrived_ns = now;
      EXPECT_EQ(renderer.answered(answer), gain == 1.0) << ms;
    }
    (void)renderer.at(nullptr, now, kNoLimit);
  }
  EXPECT_EQ(renderer.at(nullptr, now, kNoLimit).gain, gain);
  EXPECT_EQ(renderer.tooLate(), gain == 1.0 ? 0U : static_cast<std::uint64_t>(kMost - delay_ms));
}

INSTANTIATE_TEST_SUITE_P(By, Delayed,
                         ::testing::Values(std::pair(0, 1.0), std::pair(49, 1.0), std::pair(51, 0.0),
                                           std::pair(1500, 0.0)),
                         [](const auto& named) { return std::to_string(named.param.first) + "ms"; });

// A driver that sends seldom, and reads late for the first time: a server answers its newest pose in each tick.
TEST_F(Pressed, AnAnswerThatIsRepeatedIsAsGoodAsTheFirst) {
  renderer.sent(8, kPose, now);
  answer.pose_seq = 8;
  answer.first_arrived_ns = now + kMs;
  Answer first_read = answer;
  first_read.arrived_ns = now + 60 * kMs;
  ForceRenderer late = renderer;
  EXPECT_TRUE(late.answered(first_read));
  for (int ms = 0; ms < 200; ++ms) {
    answer.arrived_ns = now += kMs;
    ASSERT_TRUE(renderer.answered(answer));
    ASSERT_EQ(renderer.at(nullptr, now, kNoLimit).gain, 1.0) << ms;
  }
}

TEST(ForceRenderer, IsZeroBeforeTheFirstAnswer) {
  ForceRenderer renderer(0.002);
  renderer.sent(1, {0, 0, 0}, 0);
  const Point p{0, 0, 0};
  const Force force = renderer.at(&p, kMs, kNoLimit);
  EXPECT_EQ(sizeOf(force.force), 0.0);
  EXPECT_EQ(force.gain, 0.0);
  EXPECT_TRUE(std::isinf(force.age_s));
}

}  // namespace
}  // namespace palpate::haptic
