// SPDX-License-Identifier: Apache-2.0
// Targets with jitter become a steady path.
#include "core/devices/path/pose_follower.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace palpate::device {
namespace {

constexpr std::int64_t kMs = 1'000'000;
constexpr double kSpeed = 0.5;

TEST(PoseFollower, SaysNothingBeforeTheFirstTargetAndStartsThere) {
  PoseFollower follower(0, kSpeed);
  EXPECT_FALSE(follower.step(kMs).has_value());
  follower.target({{0.1, 0.2, 0.3}}, 2 * kMs);
  const auto p = follower.step(3 * kMs);
  ASSERT_TRUE(p.has_value());
  EXPECT_EQ(*p, (Point{{0.1, 0.2, 0.3}}));
}

// A page that drags at 50 mm/s and sends at 60 Hz +- 8 ms.
std::vector<Point> drag(PoseFollower& follower, double speed, std::int64_t until) {
  std::mt19937 random(3);
  std::uniform_int_distribution<std::int64_t> jitter(-8 * kMs, 8 * kMs);
  std::vector<Point> poses;
  std::int64_t next = kMs;
  std::int64_t beat = kMs;
  for (std::int64_t now = kMs; now <= until; now += kMs) {
    if (now >= next) {
      follower.target({{speed * static_cast<double>(now) * 1e-9, 0.0, 0.0}}, now);
      beat += 16'666'667;
      next = beat + jitter(random);
    }
    if (const auto p = follower.step(now)) poses.push_back(*p);
  }
  return poses;
}

TEST(PoseFollower, MakesASteadyWayOutOfTargetsThatJitter) {
  PoseFollower follower(0, kSpeed);
  const auto poses = drag(follower, 0.05, 3000 * kMs);
  ASSERT_GT(poses.size(), 2900U) << "one pose a millisecond";
  int slow = 0;
  double fastest = 0.0;
  for (std::size_t i = 501; i < poses.size(); ++i) {
    const double v = (poses[i][0] - poses[i - 1][0]) * 1e3;
    slow += v < 0.025 ? 1 : 0;
    fastest = std::max(fastest, v);
  }
  EXPECT_LE(slow, 5) << "stands only where an interval is longer than all before, not at every target";
  EXPECT_LT(fastest, 0.075);
  EXPECT_NEAR(poses.back()[0], 0.05 * 3.0, 0.05 * 0.06) << "at most 60 ms behind";
  EXPECT_LE(follower.delay(), 0.05);
}

TEST(PoseFollower, NeverGoesFasterThanItsLimit) {
  PoseFollower follower(0, kSpeed);
  follower.target({}, kMs);
  Point last = *follower.step(2 * kMs);
  for (std::int64_t now = 3 * kMs; now < 600 * kMs; now += kMs) {
    if (now % (16 * kMs) == 0) follower.target({{now % (32 * kMs) == 0 ? 1.0 : -1.0, 0.0, 0.0}}, now);
    const Point p = *follower.step(now);
    EXPECT_LE(length(p - last), kSpeed * 1e-3 * (1.0 + 1e-9));
    last = p;
  }
  const Point before = last;  // a stall of this machine is not made up for in one stride
  follower.target({{1.0, 0.0, 0.0}}, 700 * kMs);
  EXPECT_LE(length(*follower.step(700 * kMs) - before), kSpeed * 5e-3 * (1.0 + 1e-9));
}

TEST(PoseFollower, ReachesATargetThatRestsAndStaysThere) {
  PoseFollower follower(0, kSpeed);
  const Point rest{{0.01, 0.0, 0.0}};
  follower.target({}, 0);
  for (std::int64_t now = kMs; now < 400 * kMs; now += kMs) {
    if (now % (10 * kMs) == 0) follower.target(rest, now);
    (void)follower.step(now);
  }
  EXPECT_EQ(follower.position(), rest);
}

TEST(PoseFollower, EndsWhenThePageIsSilentForAQuarterSecond) {
  PoseFollower follower(0, kSpeed);
  follower.target({}, 100 * kMs);
  EXPECT_TRUE(follower.step(350 * kMs).has_value());
  EXPECT_FALSE(follower.step(351 * kMs).has_value());
  EXPECT_EQ(follower.state(), PoseFollower::State::kOver);
  follower.target({}, 352 * kMs);
  EXPECT_FALSE(follower.step(353 * kMs).has_value()) << "it does not come back by itself";
}

TEST(PoseFollower, WaitsTwoSecondsForTheFirstTarget) {
  PoseFollower follower(0, kSpeed);
  EXPECT_FALSE(follower.step(2000 * kMs).has_value());
  EXPECT_EQ(follower.state(), PoseFollower::State::kWaiting);
  EXPECT_FALSE(follower.step(2001 * kMs).has_value());
  EXPECT_EQ(follower.state(), PoseFollower::State::kOver);
}

TEST(PoseFollower, LiftsOffOutwardsAfterARelease) {
  PoseFollower follower(0, kSpeed);
  follower.target({}, 0);
  (void)follower.step(kMs);
  follower.release({{0.0, 0.6, 0.8}});
  Point last{};
  std::int64_t now = kMs;
  while (follower.state() == PoseFollower::State::kLifting && now < 2000 * kMs) {
    now += kMs;
    follower.target({{1.0, 0.0, 0.0}}, now);  // on its way when the page let go
    const auto p = follower.step(now);
    ASSERT_TRUE(p.has_value());
    EXPECT_LE(length(*p - last), PoseFollower::kLiftSpeed * 1e-3 * (1.0 + 1e-9));
    last = *p;
  }
  EXPECT_EQ(follower.state(), PoseFollower::State::kOver);
  EXPECT_NEAR(last[1], 0.6 * PoseFollower::kLift, 1e-6);
  EXPECT_NEAR(last[2], 0.8 * PoseFollower::kLift, 1e-6);
  EXPECT_FALSE(follower.step(now + kMs).has_value());
}

TEST(PoseFollower, GrabbedAgainWhileItLiftsGoesOnFromWhereItIs) {
  PoseFollower follower(0, kSpeed);
  follower.target({}, 0);
  (void)follower.step(kMs);
  follower.release({{0.0, 0.0, 1.0}});
  for (std::int64_t now = 2 * kMs; now <= 50 * kMs; now += kMs) (void)follower.step(now);
  const Point lifted = follower.position();
  ASSERT_GT(lifted[2], 0.004);
  follower.regrab(50 * kMs);
  EXPECT_FALSE(follower.step(51 * kMs).has_value());
  Point last = lifted;
  for (std::int64_t now = 60 * kMs; now < 500 * kMs; now += kMs) {
    if (now % (10 * kMs) == 0) follower.target({{0.0, 0.01, 0.0}}, now);
    const auto p = follower.step(now);
    ASSERT_TRUE(p.has_value());
    EXPECT_LE(length(*p - last), kSpeed * 1e-3 * (1.0 + 1e-9));
    last = *p;
  }
  EXPECT_EQ(last, (Point{{0.0, 0.01, 0.0}}));
}

}  // namespace
}  // namespace palpate::device
