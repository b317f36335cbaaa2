// SPDX-License-Identifier: Apache-2.0
// Several tools on one organ, from tick to tick: at rest, coming down, lifted.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "../load_driven.h"
#include "../round_organ.h"
#include "core/surface/smooth_places.h"
#include "palpate/testing/sanitizers.h"

namespace palpate::testing {

namespace {

/// An organ that goes along as a whole, as a soft one with a clamp far away does.
const MetaModel& softOrgan() {
  static const MetaModel model = spoiled({}, goesAlong);
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
  for (const std::size_t tools : fewUnderSanitizers<std::size_t>(1, {4, 3, 2}))
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
  constexpr double kAdvance = 1e-5;  // m
  for (const double coupling : {300.0, kInfinity}) {
    Driver driver(softOrgan(), bare(kInfinity, coupling));
    press(driver, 3, 0.002);
    const Vec3 before = forceOn(driver, 0);
    const ToolResult sent = driver.result().tools[0];
    place(driver, 0, 0.002 + kAdvance);
    for (int i = 0; i < 50; ++i) driver.tick();
    const double slope = (forceOn(driver, 0) - before).z() / -kAdvance;
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
    for (float& y : data.green_Y) y *= 1e30F;
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

namespace {

/// An organ of springs, each point's own on a ground that all share: linear, and reciprocal to the last digit,
///   u(X) = f / k on its own patch,   u(X) = c (1 + cos(X, X')) / 2 f elsewhere;   k differs from place to place.
const MetaModel& reciprocalOrgan() {
  constexpr double kStiffness = 400.0, kShared = 0.7, kContrast = 0.2;
  constexpr std::size_t kModes = 12;  // 1, x, y, z, of each axis
  const auto part = [](const Vec3& n, std::size_t j) {
    return j == 0 ? std::sqrt(0.5) : std::sqrt(0.5) * n[static_cast<Eigen::Index>(j - 1)];
  };
  static const MetaModel model = spoiled({}, [&](modelfile::ModelData& data) {
    const SyntheticOptions options;
    const std::size_t nodes = data.surface_positions.size() / 3, positions = data.contact_node.size();
    const auto C = static_cast<std::size_t>(MonomialBasis(options.order).size());
    const auto stiffness = [&](const Vec3& n) {
      return kStiffness * (1.0 + kContrast * std::sin(3.0 * n.x() + 2.0 * n.y() + n.z()));
    };
    const auto normal = [&](std::size_t node) -> Vec3 {
      return Eigen::Map<const Vec3>(data.surface_positions.data() + 3 * node).normalized();
    };
    data.modes_X.assign(kModes * 3 * nodes, 0.0F);
    data.modes_Y.assign(positions * (C - 3) * kModes, 0.0F);
    data.green_Y.assign(positions * 3 * kModes, 0.0F);
    std::fill(data.near_field.begin(), data.near_field.end(), 0.0F);
    std::fill(data.green_near.begin(), data.green_near.end(), 0.0F);
    std::fill(data.contact_force.begin(), data.contact_force.end(), 0.0);
    for (std::size_t mode = 0; mode < kModes; ++mode)
      for (std::size_t node = 0; node < nodes; ++node)
        data.modes_X[(mode * nodes + node) * 3 + mode % 3] = static_cast<float>(part(normal(node), mode / 3));
    for (std::size_t m = 0; m < positions; ++m) {
      const Vec3 n = normal(static_cast<std::size_t>(data.contact_node[m]));
      for (std::size_t mode = 0; mode < kModes; ++mode)
        data.green_Y[(3 * m + mode % 3) * kModes + mode] =
            static_cast<float>(kShared / kStiffness * part(n, mode / 3));
      for (std::size_t axis = 0; axis < 3; ++axis)
        data.contact_force[(m * C + axis) * 3 + axis] = stiffness(n) * options.reference_displacement;
    }
    fillStiffness(data, [&](const Vec3& X) -> Mat3 { return stiffness(X.normalized()) * Mat3::Identity(); });
  });
  return model;
}

/// What a hand does that leads one tool.
class Hand {
 public:
  Hand(Driver& driver, std::size_t tool) : driver_(driver), tool_(tool) {}
  void to(const Vec3& c) {
    driver_.input().tools[tool_].present = 1;
    driver_.input().tools[tool_].position = {c.x(), c.y(), c.z()};
    driver_.tick();
    const Vec3 force = forceOn(driver_, tool_);
    work_ -= 0.5 * (force + force_).dot(c - c_);
    most_ = std::max(most_, work_);
    force_ = force;
    c_ = c;
  }
  [[nodiscard]] double work() const { return work_; }  // J, so far,
  [[nodiscard]] double most() const { return most_; }  // and at most

 private:
  Driver& driver_;
  std::size_t tool_;
  Vec3 c_ = Vec3::Zero(), force_ = Vec3::Zero();
  double work_{0.0}, most_{0.0};
};

}  // namespace

TEST(ToolsTogether, SlidingBesideAnotherToolKeepsTheEnergy) {
  constexpr double kHeld = 0.0025, kSliding = 0.002, kClear = -0.003, kAdvance = 2e-5;  // m
  constexpr double kNear = 0.4, kFar = 1.4;  // rad from the held one
  for (const double coupling : {300.0, kInfinity})
    for (const double azimuth : fewUnderSanitizers(1, {0.3, 2.0, 4.0}))
      for (const bool away : {true, false}) {
        StepConfig config = bare(0.0, coupling);
        config.own[0] = toolSettings(bare(kInfinity))[0];
        Driver driver(reciprocalOrgan(), config);
        Hand held(driver, 0), sliding(driver, 1);
        for (double depth = -0.001; depth < kHeld; depth += kAdvance) held.to(over(0.0, depth));
        const double from = away ? kNear : kFar, to = away ? kFar : kNear;
        for (double depth = kClear; depth < kSliding; depth += kAdvance)
          sliding.to(over(from, depth, azimuth));
        for (double way = 0.0; way < 1.0; way += 5e-4)
          sliding.to(over(from + way * (to - from), kSliding, azimuth));
        for (double depth = kSliding; depth > kClear; depth -= kAdvance) sliding.to(over(to, depth, azimuth));
        ASSERT_EQ(driver.result().tools[0].state, static_cast<std::uint32_t>(ContactState::kStick));
        ASSERT_EQ(forceOn(driver, 1), Vec3(Vec3::Zero()));
        EXPECT_LT(std::abs(sliding.work()), 0.002 * (held.most() + sliding.most()))
            << "coupling " << coupling << ", azimuth " << azimuth << ", from " << from << " to " << to;
      }
}

TEST(ToolsTogether, AToolThatTheOrganWouldPullDoesNotShakeTheOthers) {
  const MetaModel half = spoiled({}, [](modelfile::ModelData& data) {  // pulls where x is below 0
    const std::size_t width = data.contact_force.size() / data.contact_node.size();
    for (std::size_t m = 0; m < data.contact_node.size(); ++m) {
      if (data.surface_positions[3 * static_cast<std::size_t>(data.contact_node[m])] > -0.01) continue;
      for (std::size_t i = m * width; i < (m + 1) * width; ++i) data.contact_force[i] *= -1.0;
    }
    const SmoothPlaces places(data.surface_positions, data.surface_triangles, data.position_of_node);
    for (std::size_t place = 0; place < places.size(); ++place) {
      const ContactPoint& s = places.views(place).front().s;
      double x = 0.0;
      for (std::size_t k = 0; k < 3; ++k) {
        const auto node = data.surface_triangles[3 * static_cast<std::size_t>(s.triangle) + k];
        x += s.barycentric[k] * data.surface_positions[3 * static_cast<std::size_t>(node)];
      }
      if (x > -0.01) continue;
      for (std::size_t i = 0; i < kStiffnessNumbers; ++i)
        data.contact_stiffness[place * kStiffnessNumbers + i] *= -1.0;
    }
  });
  StepConfig config;
  config.friction = kInfinity;
  Driver driver(half, config);
  press(driver, 1, 0.002);
  ASSERT_GT(forceOn(driver, 0).norm(), 0.5);
  const double radius = SyntheticOptions{}.radius + config.tip_radius;
  const auto put = [&](double depth) {
    driver.input().tools[1].present = 1;
    driver.input().tools[1].position = {depth - radius, 0.0, 0.0};
    driver.tick();
  };
  for (double depth = -0.002; depth < 0.002; depth += 1e-4) put(depth);
  for (int ms = 0; ms < 100; ++ms) {
    put(0.002);
    ASSERT_EQ(driver.result().tools[1].state, 0U) << ms << " ms";
    ASSERT_EQ(driver.result().tools[0].flags & kRamping, 0U) << ms << " ms";
  }
}

}  // namespace palpate::testing
