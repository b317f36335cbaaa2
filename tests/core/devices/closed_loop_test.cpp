// SPDX-License-Identifier: Apache-2.0
#include "core/devices/sim/closed_loop.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

namespace palpate::device {
namespace {

const Point kSurface{0, 0, 0.05};
const Point kUp{0, 0, 1};

struct Wall {
  double stiffness;  // N/m
  double tip_radius{0.005};
  Point operator()(const Point& p) const {
    const double depth = tip_radius - dot(p - kSurface, kUp);
    return depth > 0.0 ? stiffness * depth * kUp : Point{};
  }
};

struct Run {
  Verdict verdict;
  double work;
};

Run run(const std::string& kind, double wall, const Mechanics& device = {0.045, 0.005, 0.0},
        const Hand& hand = {}, std::size_t delay = 1) {
  const Motion motion = makeMotion(kind, kSurface, kUp, {.lead = leadOf(device, hand)});
  HeldDevice held(device, hand, motion.path);
  const Trace without = withoutOrgan(held, motion);
  const Trace with = closedLoop(held, motion, Wall{wall}, delay);
  return {judge(with, without, motion), held.alongForce().work};
}

TEST(ClosedLoop, ASoftSpringIsStable) {
  const auto [verdict, work] = run("press", 300.0);
  EXPECT_TRUE(verdict.stable);
  ASSERT_TRUE(verdict.settle_s);
  EXPECT_LT(*verdict.settle_s, 0.5);
  // Two springs in a row: the hand wants 3 mm, 200 of 500 N/m are the hand's; it arrives with a small overshoot.
  EXPECT_GE(verdict.depth, 0.003 * 200.0 / 500.0);
  EXPECT_LT(verdict.depth, 1.1 * 0.003 * 200.0 / 500.0);
  EXPECT_NEAR(verdict.max_force, 300.0 * verdict.depth, 0.01);
}

// A spring k, sampled and held each T and answered after td, has a negative damping of k (T/2 + td). The limit is where that
// equals the damping of hand and device (Diolaiti et al. 2006, without Coulomb friction). The spring pulls too, so that
// contact is never lost and the loop is linear.
bool grows(double k, std::size_t delay) {
  const Motion motion = makeMotion("press", kSurface, kUp, {});
  HeldDevice held({0.045, 0.005, 0.0}, {}, motion.path);
  const Trace trace = closedLoop(
      held, motion,
      [k](const Point& p) {
        return Point{0, 0, k * (0.055 - p[2])};
      },
      delay);
  return oscillationIn(trace, motion).growing;
}

TEST(ClosedLoop, TheStabilityLimitIsWhereTheorySaysItIs) {
  const double damping = 2.005;
  const double limit_at_once = damping / 0.5e-3, limit_delayed = damping / 1.5e-3;  // N/m
  EXPECT_FALSE(grows(0.93 * limit_at_once, 0));
  EXPECT_TRUE(grows(1.07 * limit_at_once, 0));
  EXPECT_FALSE(grows(0.93 * limit_delayed, 1));
  EXPECT_TRUE(grows(1.07 * limit_delayed, 1));
}

TEST(ClosedLoop, WhatRingsLongerThanTheHandIsNotCalledStable) {
  EXPECT_TRUE(run("press", 600.0).verdict.stable);
  EXPECT_FALSE(run("press", 1300.0).verdict.stable) << "below the limit of 1337 N/m, but hardly damped";
}

TEST(ClosedLoop, AStiffSpringWithDelayIsUnstableAndGivesEnergy) {
  for (const char* kind : {"press", "drag", "tap"}) {
    const auto [verdict, work] = run(kind, 5000.0);
    EXPECT_FALSE(verdict.stable) << kind;
    EXPECT_GT(verdict.oscillation_pp, 1e-3) << kind;
    EXPECT_GT(verdict.oscillation_pp, 2.0 * verdict.oscillation_without_organ_pp + kNoiseFloor) << kind;
    EXPECT_GT(work, 0.0) << kind << ": a passive wall cannot";
  }
}

TEST(ClosedLoop, EveryMotionIsStableOnASoftSpring) {
  for (const DevicePreset& preset : devicePresets())
    for (const char* kind : {"press", "drag", "tap"})
      EXPECT_TRUE(run(kind, 300.0, mechanicsOf(preset)).verdict.stable) << preset.name << " " << kind;
}

TEST(ClosedLoop, ALooseHandBringsADeviceWithFrictionToTheOrgan) {
  const Hand loose{0.02, 0.5, 50.0};
  const Mechanics touch = mechanicsOf(*findDevicePreset("touch"));
  const Motion motion = makeMotion("press", kSurface, kUp, {.lead = leadOf(touch, loose)});
  HeldDevice held(touch, loose, motion.path);
  const Trace without = withoutOrgan(held, motion);
  EXPECT_NEAR(judge(without, without, motion).depth, 0.003, 6e-4) << "as deep as the hand wants, and a swing";
  const Motion timid = makeMotion("press", kSurface, kUp, {});
  HeldDevice stuck(touch, loose, timid.path);
  const Trace never = withoutOrgan(stuck, timid);
  EXPECT_EQ(judge(never, never, timid).depth, 0.0) << "without the lead it never gets there";
  EXPECT_GT(run("press", 300.0, touch, loose).verdict.depth, 3e-4);
}

TEST(ClosedLoop, ARunThatFliesAwayIsUnstable) {
  const Motion motion = makeMotion("press", kSurface, kUp, {});
  HeldDevice held({}, {}, motion.path);
  const Trace without = withoutOrgan(held, motion);
  const Trace with = closedLoop(held, motion, [](const Point&) { return Point{NAN, 0, 0}; });
  const Verdict verdict = judge(with, without, motion);
  EXPECT_FALSE(verdict.stable);
  EXPECT_FALSE(verdict.settle_s);
}

// Judgement of traces known in closed form.
Trace swinging(const Motion& motion, double amplitude, double rate) {
  Trace trace{1e-3, {}, {}};
  for (int i = 0; i <= 4000; ++i) {
    const double t = 1e-3 * i;
    const double growth = std::exp(rate * (t - motion.hold_start));
    trace.position.push_back(motion.path.at(t) + amplitude * growth * std::sin(60.0 * t) * kUp);
    trace.force.push_back({});
  }
  return trace;
}

TEST(Oscillation, IsTheMotionAboutTheTrend) {
  const Motion motion = makeMotion("press", kSurface, kUp, {});
  const Oscillation steady = oscillationIn(swinging(motion, 1e-3, 0.0), motion);
  EXPECT_NEAR(steady.pp, 2e-3, 0.3e-3) << "a running mean leaves up to 14 % at 9.5 Hz";
  EXPECT_FALSE(steady.growing);
  EXPECT_TRUE(oscillationIn(swinging(motion, 1e-4, 1.0), motion).growing);
  EXPECT_FALSE(oscillationIn(swinging(motion, 1e-3, -1.0), motion).growing);
  EXPECT_NEAR(oscillationIn(swinging(motion, 0.0, 0.0), motion).pp, 0.0, 1e-9);
}

TEST(Oscillation, ATraceThatEndsEarlyIsNotCalledStable) {
  const Motion motion = makeMotion("press", kSurface, kUp, {});
  Trace trace = swinging(motion, 0.0, 0.0);
  trace.position.resize(2000);
  EXPECT_FALSE(judge(trace, swinging(motion, 0.0, 0.0), motion).stable);
}

// A stall moves the tip as a blow does: what it starts is not the loop's.
TEST(Oscillation, IsJudgedBetweenStallsWhereItHasSettled) {
  const Motion motion = makeMotion("press", kSurface, kUp, {.seconds = 6.0});
  Trace trace{1e-3, std::vector<Point>(6001), std::vector<Point>(6001)};
  trace.stalled.assign(6001, false);
  trace.stalled[2500] = true;
  for (std::size_t i = 2500; i < 2800; ++i) trace.position[i] = 1e-3 * std::sin(0.1 * i) * kUp;
  const Oscillation with = oscillationIn(trace, motion);
  EXPECT_EQ(with.pp, 0.0);
  EXPECT_TRUE(with.enough);
  EXPECT_NEAR(with.seconds, (2.5 - 1.5 - 0.125) + (5.8 - 3.0 - 0.125), 5e-3);
  for (std::size_t i = 3500; i < 6000; ++i) trace.position[i] = 1e-3 * std::sin(0.1 * i) * kUp;
  EXPECT_NEAR(oscillationIn(trace, motion).pp, 2e-3, 0.3e-3) << "rings without a stall";
  trace.stalled.assign(6001, false);
  EXPECT_GT(oscillationIn(trace, motion).pp, 1e-3) << "told, it is the loop's";
}

TEST(Oscillation, OfAHoldFullOfStallsIsNotJudged) {
  const Motion motion = makeMotion("press", kSurface, kUp, {});
  Trace trace = swinging(motion, 0.0, 0.0);
  EXPECT_TRUE(judge(trace, trace, motion).judged);
  const Trace without = trace;
  trace.stalled.assign(trace.position.size(), false);
  for (std::size_t i = 0; i < trace.stalled.size(); i += 700) trace.stalled[i] = true;
  const Verdict verdict = judge(trace, without, motion);
  EXPECT_FALSE(verdict.judged);
  EXPECT_FALSE(verdict.stable) << "nothing is known of the loop";
}

TEST(SettleTime, IsWhenTheTipStaysInTheBand) {
  const Motion motion = makeMotion("press", kSurface, kUp, {});
  // 1 mm exp(-4 t) enters the band of 5 % of 3 mm after ln(1 / 0.15) / 4 s, give or take a swing.
  const auto settled = settleTime(swinging(motion, 1e-3, -4.0), motion);
  ASSERT_TRUE(settled);
  EXPECT_NEAR(*settled, std::log(1.0 / 0.15) / 4.0, 0.06);
  EXPECT_FALSE(settleTime(swinging(motion, 1e-3, 1.0), motion));
}

TEST(Motion, EndsWhereItStartsAndRestsAtTheDepth) {
  for (const char* kind : {"press", "drag", "tap"}) {
    const Motion motion = makeMotion(kind, kSurface, kUp, {});
    EXPECT_NEAR(motion.path.seconds(), 4.0, 1e-12);
    EXPECT_NEAR(motion.path.at(0.0)[2], motion.path.at(4.0)[2], 1e-12);
    for (const double t : {motion.hold_start, motion.hold_end})
      EXPECT_NEAR(motion.path.at(t)[2], 0.05 + 0.005 - 0.003, 1e-12) << kind;
  }
  EXPECT_NEAR(makeMotion("drag", kSurface, kUp, {}).path.at(4.0)[0], 0.0, 1e-12);
  EXPECT_NEAR(makeMotion("drag", kSurface, kUp, {}).path.at(3.0)[0], 0.015, 1e-12);
}

TEST(Motion, RejectsWhatCannotBeMoved) {
  const auto complaint = [](const std::string& kind, const MotionOptions& options) -> std::string {
    try {
      (void)makeMotion(kind, kSurface, kUp, options);
      return "accepted";
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
  };
  EXPECT_EQ(complaint("wave", {}), "unknown motion 'wave', expected press, drag or tap");
  EXPECT_EQ(complaint("press", {.depth = 0.06}), "depth (m) is 0.06, expected 1e-06 to 0.05");
  EXPECT_EQ(complaint("press", {.seconds = 1.5}), "seconds is 1.5, expected 2 to 3600");
  EXPECT_EQ(complaint("tap", {.taps = 0}), "number of taps is 0, expected 1 to 1000");
}

}  // namespace
}  // namespace palpate::device
