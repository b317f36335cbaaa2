// SPDX-License-Identifier: Apache-2.0
// Live changes ramp, also those from and to infinity, between which there are no numbers.
#include "core/tick/live_blend.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "../round_organ.h"

namespace palpate::testing {

namespace {

StepConfig open() {
  StepConfig config;
  config.friction = config.force_limit = kInfinity;
  return config;
}

void press(Driver& driver, double depth, double aside) {
  for (double z = -0.001; z < depth; z += 5e-5) driver.at(above(z));
  for (double x = 0.0; x < aside; x += 5e-5) driver.at(above(depth, x));
  driver.settle(above(depth, aside));
}

struct Course {
  double before{0.0}, after{0.0};  // |force|, N
  double change{0.0};              // |force after - force before|, N
  double steepest{0.0};            // |change of the force| in one tick, N
  double longest{0.0};             // |force| over the limit in force, largest of all ticks
};

/// Goes over to `live` while the tool rests.
Course goOver(Driver& driver, const LiveParameters& live, const Vec3& c) {
  const Vec3 first = vec(driver.at(c).force);
  Course course{first.norm()};
  Vec3 last = first;
  driver.input().has_settings = 1;
  driver.input().settings[0].live = live;
  for (int ms = 0; ms < 300; ++ms) {
    const Vec3 now = vec(driver.at(c).force);
    course.steepest = std::max(course.steepest, (now - last).norm());
    course.longest = std::max(course.longest, now.norm() / driver.work().live().force_limit);
    last = now;
  }
  course.after = last.norm();
  course.change = (last - first).norm();
  return course;
}

constexpr double kMostAtOnce = 0.05;  // of the whole change, in one tick; ramp_time is 30 ms

}  // namespace

TEST(LiveBlend, AStuckToolUnderTensionIsLetGoWithoutAStep) {
  for (const auto& [depth, aside] : {std::pair(0.002, 0.004), std::pair(0.001, 0.006)}) {  // f_t / f_n 1.3, 4
    StepConfig config = open();
    Driver driver(roundOrgan(), config);
    press(driver, depth, aside);
    LiveParameters live = liveParameters(config);
    live.friction = 0.3;
    const Course course = goOver(driver, live, above(depth, aside));
    EXPECT_GT(course.change, 0.2 * course.before);
    EXPECT_LE(course.steepest, kMostAtOnce * course.change) << "depth " << depth << ", aside " << aside;
  }
}

TEST(LiveBlend, AForceLimitComesFromInfinityWithoutAStepAndIsKept) {
  StepConfig config = open();
  config.youngs_modulus = 6e6;
  Driver driver(roundOrgan(), config);
  press(driver, 0.006, 0.0);
  LiveParameters live = liveParameters(config);
  live.force_limit = 3.3;
  const Course course = goOver(driver, live, above(0.006));
  EXPECT_GT(course.before, 50.0);
  EXPECT_NEAR(course.after, 3.3, 1e-6);
  EXPECT_LE(course.steepest, kMostAtOnce * course.change);
  EXPECT_LE(course.longest, 1.0 + 1e-9);
  live.force_limit = kInfinity;
  const Course back = goOver(driver, live, above(0.006));
  EXPECT_NEAR(back.after, course.before, 1e-6 * course.before);
  EXPECT_LE(back.steepest, kMostAtOnce * back.change);
}

TEST(LiveBlend, ACouplingComesAndGoesWithoutAStep) {
  for (const double E : {1e4, 1e6}) {
    StepConfig config = open();
    config.youngs_modulus = E;
    Driver driver(roundOrgan(), config);
    press(driver, 0.003, 0.0);
    LiveParameters live = liveParameters(config);
    live.coupling_stiffness = 300.0;
    live.coupling_damping = 0.3;
    const Course course = goOver(driver, live, above(0.003));
    EXPECT_LT(course.after, course.before);
    EXPECT_LE(course.steepest, kMostAtOnce * course.change) << E;
    live = liveParameters(config);
    const Course back = goOver(driver, live, above(0.003));
    EXPECT_NEAR(back.after, course.before, 1e-6 * course.before);
    EXPECT_LE(back.steepest, kMostAtOnce * back.change) << E;
  }
}

TEST(LiveBlend, ARateLimitThatRisesLetsGoWithoutAStep) {
  for (const double rate : {1e6, kInfinity}) {
    StepConfig config = open();
    config.force_rate_limit = 10.0;
    Driver driver(roundOrgan(), config);
    for (double z = -0.001; z < 0.004; z += 5e-5) driver.at(above(z));
    LiveParameters live = liveParameters(config);
    live.force_rate_limit = rate;
    const Course course = goOver(driver, live, above(0.004));
    EXPECT_GT(course.change, 0.5) << "it lagged behind";
    EXPECT_LE(course.steepest, kMostAtOnce * course.change) << rate;
  }
}

TEST(LiveBlend, AChangeDuringATickWithoutAGoodPoseIsNotForgotten) {
  StepConfig config = open();
  config.youngs_modulus = 1e6;
  Driver driver(roundOrgan(), config);
  press(driver, 0.003, 0.0);
  const Vec3 before = vec(driver.result().tools[0].force);
  driver.input().has_settings = 1;
  driver.input().settings[0].live = liveParameters(config);
  driver.input().settings[0].live.coupling_stiffness = 300.0;
  driver.at(Vec3::Constant(std::numeric_limits<double>::quiet_NaN()));
  EXPECT_LT((vec(driver.at(above(0.003)).force) - before).norm(), 0.05 * before.norm());
}

TEST(LiveBlend, TheDampingFitsTheCouplingOnTheWayToo) {
  LiveParameters live = liveParameters(StepConfig{});
  live.coupling_stiffness = 300.0;
  live.coupling_damping = 1.5;
  LiveBlend blend({0.0, live}, {1e5, kInfinity});
  live.coupling_stiffness = 10.0;
  live.coupling_damping = 0.05;
  for (int ms = 0; ms < 110; ++ms) {
    blend.advance({0.0, live}, 1e-3, 0.0);
    ASSERT_FALSE(firstComplaint(blend.now())) << ms << " ms";
  }
  EXPECT_EQ(blend.now().coupling_damping, 0.05);
}

TEST(LiveParameters, ForceScalesWithTheModulusAndNeverJumps) {
  Driver driver(roundOrgan(), bare(kInfinity));
  for (double d = -0.001; d < 0.002; d += 5e-5) driver.at(over(0.0, d));
  const double before = vec(driver.at(over(0.0, 0.002)).force).norm();
  driver.input().has_settings = 1;
  driver.input().settings[0].live = liveParameters(bare(kInfinity));
  driver.input().settings[0].live.youngs_modulus = 2.0 * roundOrgan().attributes().E;
  double last = before;
  for (int ms = 0; ms < 150; ++ms) {
    const double now = vec(driver.at(over(0.0, 0.002)).force).norm();
    ASSERT_LT(std::abs(now - last), 0.02 * before);
    last = now;
  }
  EXPECT_NEAR(last, 2.0 * before, 1e-6 * before);
}

}  // namespace palpate::testing
