// SPDX-License-Identifier: Apache-2.0
#include "core/devices/sim/contact_energy.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/devices/sim/closed_loop.h"

namespace palpate::device {
namespace {

const Point kTop{0, 0, 0.05};
const Point kNormal{0, 0, 1};
constexpr double kLag =
    1.5e-3;  // s: the answer acts a period later and is held for one, which lags by half of it

Point spring(double stiffness, const Point& tip) {
  const double depth = 0.055 - tip[2];
  return depth > 0.0 ? stiffness * depth * kNormal : Point{};
}

Trace tapped(double stiffness, const Mechanics& device = {0.045, 0.005, 0.0}, const Hand& hand = {},
             std::size_t delay = 1) {
  const Motion motion = makeMotion("tap", kTop, kNormal, {.lead = leadOf(device, hand)});
  HeldDevice held(device, hand, motion.path);
  return closedLoop(
      held, motion, [&](const Point& tip) { return spring(stiffness, tip); }, delay);
}

// The integral of F . dx over a contact with a spring whose force lags by T is k T times that of v^2 dt, whatever the motion.
TEST(ContactEnergy, ADelayedSpringGivesItsStiffnessTimesItsLag) {
  for (const double stiffness : {100.0, 300.0, 600.0}) {
    const EnergyVerdict energy = judgeEnergy(tapped(stiffness));
    ASSERT_GE(energy.contacts.size(), 4U) << "three taps and the hold";
    const AlongForce& sum = energy.judged;
    EXPECT_GT(sum.work, 0.0);
    EXPECT_NEAR(sum.work / sum.speed_squared, stiffness * kLag, 0.05 * stiffness * kLag) << stiffness;
    EXPECT_NEAR(sum.damped, 2.005 * sum.speed_squared, 1e-9 * sum.damped)
        << "without friction b + B damps alone";
    EXPECT_TRUE(energy.holds()) << "device and hand damp more";
  }
}

TEST(ContactEnergy, AtOnceItGivesAThirdOfThat) {
  const AlongForce at_once = judgeEnergy(tapped(300.0, {0.045, 0.005, 0.0}, {}, 0)).judged;
  EXPECT_NEAR(at_once.work / at_once.speed_squared, 300.0 * 0.5e-3, 0.1 * 300.0 * 0.5e-3) << "half a period";
}

TEST(ContactEnergy, WhatIsStifferThanItsDampingCanBearDoesNotHold) {
  const Hand loose{0.02, 0.5, 50.0};
  const double limit = 0.505 / kLag;  // N/m
  EXPECT_TRUE(judgeEnergy(tapped(0.8 * limit, {0.05, 0.005, 0.0}, loose)).holds());
  const EnergyVerdict stiff = judgeEnergy(tapped(3.0 * limit, {0.05, 0.005, 0.0}, loose));
  EXPECT_FALSE(stiff.holds());
  ASSERT_NE(stiff.worst(), nullptr);
  EXPECT_GT(stiff.worst()->excess(), stiff.worst()->floor());
}

TEST(ContactEnergy, CoulombFrictionDampsToo) {
  const Hand loose{0.02, 0.5, 50.0};
  const AlongForce with = judgeEnergy(tapped(300.0, {0.05, 0.005, 0.26}, loose)).judged;
  EXPECT_GT(with.damped, 0.505 * with.speed_squared);
}

// What one period of a trace adds: work and damping in mJ, no way that counts.
struct Written {
  Trace trace{1e-3, {Point{}}, {Point{}}, {AlongForce{}}, {false}};

  void add(double force, double work_mJ, double damped_mJ, bool stalled = false) {
    const AlongForce before = trace.energy.back();
    trace.position.push_back({});
    trace.force.push_back({0, 0, force});
    trace.energy.push_back({before.work + 1e-3 * work_mJ, before.damped + 1e-3 * damped_mJ, 0.0});
    trace.stalled.push_back(stalled);
  }
};

TEST(ContactEnergy, EachContactIsJudgedByItself) {
  Written written;
  written.add(1.0, -2.0, 0.5);
  written.add(0.0, 0.0, 7.0);  // damped in the air
  written.add(1.0, 0.5, 0.1);
  written.add(0.0, 0.0, 0.0);
  const EnergyVerdict energy = judgeEnergy(written.trace);
  ASSERT_EQ(energy.contacts.size(), 2U);
  EXPECT_TRUE(energy.contacts[0].holds());
  EXPECT_FALSE(energy.contacts[1].holds())
      << "what the first one took, and what the air damps, helps nothing";
  EXPECT_EQ(energy.worst(), &energy.contacts[1]);
  EXPECT_NEAR(energy.worst()->excess(), 0.4e-3, 1e-12);
  EXPECT_FALSE(energy.holds());
}

TEST(ContactEnergy, AContactWithAStallIsToldApart) {
  Written written;
  written.add(1.0, 0.0, 0.1);
  written.add(1.0, 3.0, 0.1, true);
  written.add(0.0, 0.0, 0.0);
  written.add(1.0, -1.0, 0.0);
  written.add(0.0, 0.0, 0.0);
  const EnergyVerdict energy = judgeEnergy(written.trace);
  EXPECT_EQ(energy.stalls, 1U);
  EXPECT_NEAR(energy.stalled.work, 3e-3, 1e-12);
  EXPECT_NEAR(energy.judged.work, -1e-3, 1e-12);
  EXPECT_TRUE(energy.holds());
}

TEST(ContactEnergy, WhatNoDeviceCouldShowIsNoGain) {
  Written written;
  written.add(1.0, 1e3 * 0.9 * kNoiseFloor, 0.0);
  written.add(0.0, 0.0, 0.0);
  EXPECT_TRUE(judgeEnergy(written.trace).holds());
  written.add(1.0, 1e3 * 1.1 * kNoiseFloor, 0.0);
  written.add(0.0, 0.0, 0.0);
  EXPECT_FALSE(judgeEnergy(written.trace).holds());
}

TEST(ContactEnergy, AContactThatDoesNotEndIsNotJudged) {
  Written written;
  written.add(1.0, 5.0, 0.0);
  EXPECT_TRUE(judgeEnergy(written.trace).contacts.empty());
  EXPECT_EQ(judgeEnergy(written.trace).worst(), nullptr);
}

TEST(ContactEnergy, ANumberThatIsNoneDoesNotHold) {
  Written written;
  written.add(1.0, NAN, 0.0);
  written.add(0.0, 0.0, 0.0);
  EXPECT_FALSE(judgeEnergy(written.trace).holds());
}

}  // namespace
}  // namespace palpate::device
