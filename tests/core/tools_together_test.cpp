// SPDX-License-Identifier: Apache-2.0
// Several tools on one organ, from tick to tick: at rest, coming down, lifted.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "load_driven.h"
#include "round_organ.h"

namespace palpate::testing {

namespace {

constexpr double kShared = 0.8;  // of what a tool does to its patch, the whole organ does

/// An organ that goes along as a whole, as a soft one with a clamp far away does.
const MetaModel& softOrgan() {
  static const MetaModel model = spoiled({}, [](modelfile::ModelData& data) {
    const std::size_t nodes = data.surface_positions.size() / 3, positions = data.contact_node.size();
    const std::size_t C =
        data.modes_Y.size() / positions / static_cast<std::size_t>(SyntheticOptions{}.modes);
    constexpr std::size_t kModes = 3;
    data.modes_X.assign(kModes * 3 * nodes, 0.0F);
    data.modes_Y.assign(positions * C * kModes, 0.0F);
    for (std::size_t axis = 0; axis < kModes; ++axis) {
      for (std::size_t node = 0; node < nodes; ++node)
        data.modes_X[axis * 3 * nodes + 3 * node + axis] = 1.0F;
      for (std::size_t m = 0; m < positions; ++m)
        data.modes_Y[(m * C + axis) * kModes + axis] =
            static_cast<float>(kShared * SyntheticOptions{}.reference_displacement);
    }
    std::fill(data.near_field.begin(), data.near_field.end(), 0.0F);
  });
  return model;
}

/// Where tool i of a few presses, and how the surface lies there.
Vec3 direction(std::size_t tool) {
  constexpr double kTilt = 0.5;  // rad from the top
  const double round = 2.1 * static_cast<double>(tool);
  return tool == 0
             ? Vec3::UnitZ()
             : Vec3(std::sin(kTilt) * std::cos(round), std::sin(kTilt) * std::sin(round), std::cos(kTilt));
}

void place(Driver& driver, std::size_t tool, double depth) {
  const Vec3 c = (SyntheticOptions{}.radius + StepConfig{}.tip_radius - depth) * direction(tool);
  driver.input().tools[tool].present = 1;
  driver.input().tools[tool].position = {c.x(), c.y(), c.z()};
}

Vec3 forceOn(const Driver& driver, std::size_t tool) {
  return vec(driver.result().tools[tool].force);
}

/// All of them go down at once, 20 mm/s, and wait.
void press(Driver& driver, std::size_t tools, double depth) {
  constexpr int kWait = 200;
  for (double d = -0.002; d < depth; d += 2e-5) {
    for (std::size_t i = 0; i < tools; ++i) place(driver, i, d);
    driver.tick();
  }
  for (std::size_t i = 0; i < tools; ++i) place(driver, i, depth);
  for (int i = 0; i < kWait; ++i) driver.tick();
}

}  // namespace

TEST(ToolsTogether, HeldStillTheyComeToRest) {
  for (const std::size_t tools : {2U, 3U, 4U})
    for (const double coupling : {300.0, kInfinity})
      for (const double friction : {0.0, 0.3, kInfinity}) {
        Driver driver(softOrgan(), bare(friction, coupling));
        press(driver, tools, 0.002);
        std::array<Vec3, kMaxTools> last;
        for (std::size_t i = 0; i < tools; ++i) last[i] = forceOn(driver, i);
        driver.tick();
        EXPECT_GT(last[0].norm() + last[1].norm(), 0.01) << "without friction one may be pushed off";
        for (std::size_t i = 0; i < tools; ++i)
          EXPECT_LE((forceOn(driver, i) - last[i]).norm(), 1e-6 * last[i].norm())
              << tools << " tools, coupling " << coupling << ", mu " << friction;
      }
}

TEST(ToolsTogether, TheSentStiffnessIsThatOfTheForceThatComes) {
  constexpr double kStep = 1e-5;  // m
  for (const double coupling : {300.0, kInfinity}) {
    Driver driver(softOrgan(), bare(kInfinity, coupling));
    press(driver, 3, 0.002);
    const Vec3 before = forceOn(driver, 0);
    const ToolResult sent = driver.result().tools[0];
    place(driver, 0, 0.002 + kStep);
    for (int i = 0; i < 50; ++i) driver.tick();
    const double slope = (forceOn(driver, 0) - before).z() / -kStep;
    const double off = coupling < kInfinity ? 0.2 : 0.02;  // the springs of the others give way
    EXPECT_NEAR(slope / sent.stiffness[8], 1.0, off) << "coupling " << coupling;
  }
}

TEST(ToolsTogether, ATouchInAnothersDentBeginsWithoutForce) {
  Driver driver(softOrgan(), bare(0.3, kInfinity));
  press(driver, 1, 0.004);
  for (double depth = -0.001; driver.result().tools[1].state == 0; depth += 2e-5) {
    ASSERT_LT(depth, 0.004) << "captured by now";
    place(driver, 1, depth);
    driver.tick();
    ASSERT_TRUE(depth > 0.002 || driver.result().tools[1].state == 0)
        << "the surface went away from below it";
  }
  EXPECT_LT(forceOn(driver, 1).norm(), 0.05) << "of some 0.7 N at this depth";
  EXPECT_EQ(driver.result().tools[1].flags, 1U) << "contact, and no jump to blend over";
}

TEST(ToolsTogether, ASurfaceThatAnotherLiftedHoldsTheTool) {
  Driver driver(softOrgan(), bare(0.3, kInfinity));
  const double radius = SyntheticOptions{}.radius + StepConfig{}.tip_radius;
  const Vec3 side(0.0, std::sqrt(1.0 - 0.2 * 0.2), -0.2);
  const auto put = [&driver](std::size_t tool, const Vec3& c) {
    driver.input().tools[tool].present = 1;
    driver.input().tools[tool].position = {c.x(), c.y(), c.z()};
  };
  put(1, (radius + 0.0007) * side);  // beyond the hysteresis of a release
  int changes = 0;
  std::uint32_t last = 0;
  for (double depth = -0.001; depth < 0.006; depth += 2e-5) {  // the other one comes from across and stays
    put(0, (std::min(depth, 0.004) - radius) * side);
    driver.tick();
    const std::uint32_t state = driver.result().tools[1].state;
    changes += (state == 0) == (last == 0) ? 0 : 1;
    last = state;
  }
  EXPECT_EQ(changes, 1) << "caught once, and never let go";
}

TEST(ToolsTogether, WhatIsNoNumberOfOneToolDoesNotStayWithTheOthers) {
  const MetaModel overflows = spoiled({}, [](modelfile::ModelData& data) {
    for (float& x : data.modes_X) x *= 1e30F;
    for (float& y : data.modes_Y) y *= 1e30F;
  });
  Driver driver(overflows, bare(0.3));
  press(driver, 1, 0.002);
  place(driver, 1, -0.001);  // in the air, beside it
  for (int ms = 0; ms < 5; ++ms) {
    const ToolResult& other = (driver.tick(), driver.result().tools[1]);
    ASSERT_TRUE(vec(other.anchor).allFinite() && vec(other.proxy).allFinite()) << ms << " ms";
  }
  place(driver, 0, -0.005);
  for (int ms = 0; ms < 5; ++ms) driver.tick();
  for (double depth = -0.001; depth < 0.002; depth += 2e-5) place(driver, 1, depth), driver.tick();
  EXPECT_GT(forceOn(driver, 1).norm(), 0.5) << "alone it is answered again";
}

}  // namespace palpate::testing
