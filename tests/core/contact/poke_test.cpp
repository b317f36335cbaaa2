// SPDX-License-Identifier: Apache-2.0
// Tools that come and go: grazing, deep and fast, elsewhere, from inside.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "../round_organ.h"
#include "core/tick/apply_preset.h"

namespace palpate::testing {

namespace {

constexpr std::uint32_t kOrdinary = kInContact | kRamping;

/// What a tool felt on its way.
struct Felt {
  double largest{0.0};         ///< |force|, N
  double largest_step{0.0};    ///< of the force in a tick, N
  int touched{0};              ///< ticks in contact
  int changes{0};              ///< between free and in contact
  int slips{0};                ///< between stick and slide
  int pulls{0};                ///< ticks with a force that draws the tool in
  std::uint32_t flags{0};      ///< all that were set
  Vec3 last = Vec3::Zero();    ///< force, N
  Vec3 normal = Vec3::Zero();  ///< at the anchor; of a free tool at the one that it had
  std::uint32_t state{0};
};

void feel(const ToolResult& r, Felt& felt) {
  const Vec3 force = vec(r.force);
  felt.largest = std::max(felt.largest, force.norm());
  felt.largest_step = std::max(felt.largest_step, (force - felt.last).norm());
  felt.touched += r.state != 0 ? 1 : 0;
  felt.changes += (r.state != 0) != (felt.state != 0) ? 1 : 0;
  felt.slips += r.state * felt.state == 2 ? 1 : 0;
  if (r.state != 0) felt.normal = normalAt(roundOrgan(), r);
  felt.pulls += force.dot(felt.normal) < -1e-9 * force.norm() ? 1 : 0;
  felt.flags |= r.flags;
  felt.last = force;
  felt.state = r.state;
}

/// Goes straight from one place to another. @param speed  m/s
void go(Driver& driver, const Vec3& from, const Vec3& to, double speed, Felt& felt) {
  const int ticks = static_cast<int>(std::ceil((to - from).norm() / (1e-3 * speed)));
  for (int i = 1; i <= ticks; ++i) feel(driver.at(from + (to - from) * (double(i) / ticks)), felt);
}

void wait(Driver& driver, const Vec3& c, int ticks, Felt& felt) {
  for (int i = 0; i < ticks; ++i) feel(driver.at(c), felt);
}

/// Across the outward direction at over(angle, .).
Vec3 acrossAt(double angle) {
  return (over(angle + 1e-4, 0.0) - over(angle - 1e-4, 0.0)).normalized();
}

StepConfig withFriction(double mu) {
  StepConfig config;
  config.friction = mu;
  return config;
}

}  // namespace

TEST(Poke, AGrazingPassTouchesOnceWithASmallContinuousForce) {
  constexpr double kOverlap = 1e-4, kStiffness = 450.0;  // m; N/m, normal
  for (const double mu : {0.0, 0.05, 0.3, 1.0})
    for (const double angle : {0.0, 0.37, 0.9}) {
      SCOPED_TRACE(::testing::Message() << "friction " << mu << ", angle " << angle);
      Driver driver(roundOrgan(), withFriction(mu));
      const Vec3 nearest = over(angle, kOverlap), way = 0.015 * acrossAt(angle);
      Felt felt;
      wait(driver, nearest - way, 40, felt);
      go(driver, nearest - way, nearest + way, 0.05, felt);
      EXPECT_GT(felt.touched, 100);
      EXPECT_EQ(felt.changes, 2) << "it begins and ends once";
      EXPECT_LE(felt.slips, 2);
      EXPECT_EQ(felt.flags & ~kOrdinary, 0U);
      EXPECT_EQ(felt.pulls, 0);
      EXPECT_LT(felt.largest, 1.05 * kStiffness * kOverlap * std::hypot(1.0, mu));
      EXPECT_LT(felt.largest_step, 0.05 * felt.largest);
      EXPECT_EQ(felt.last, Vec3::Zero());
    }
}

namespace {

/// A dozen pokes of 8 mm at the speed limit, over the organ's side. @param slant  m sideways per m down
/// @param[in] pause  ticks between two of them
Felt pokeFast(Driver& driver, double slant, int pause) {
  constexpr double kFast = 2.0, kDeep = 0.008, kClear = -0.006;  // m/s; m
  const auto above = [slant](double angle) {
    return Vec3(over(angle, kClear) + slant * (kDeep - kClear) * acrossAt(angle));
  };
  Felt felt;
  wait(driver, above(0.0), 40, felt);
  for (int poke = 0; poke < 12; ++poke) {
    const double angle = 0.1 * poke;
    go(driver, above(angle), over(angle, kDeep), kFast, felt);
    go(driver, over(angle, kDeep), above(angle), kFast, felt);
    go(driver, above(angle), above(angle + 0.1), 1.0, felt);
    wait(driver, above(angle + 0.1), pause, felt);
  }
  return felt;
}

void expectPushesOnlyAndLeavesNothing(const StepConfig& config, double slant, int pause) {
  SCOPED_TRACE(::testing::Message() << "coupling " << config.coupling_stiffness << ", friction "
                                    << config.friction << ", slant " << slant);
  Driver driver(roundOrgan(), config);
  const Felt felt = pokeFast(driver, slant, pause);
  EXPECT_GT(felt.touched, 80);
  EXPECT_EQ(felt.changes, 24);
  EXPECT_EQ(felt.pulls, 0);
  EXPECT_GT(felt.largest, 1.0);
  EXPECT_LE(felt.largest, config.force_limit * (1.0 + 1e-12));
  EXPECT_EQ(felt.flags & (kPoseJump | kNonFiniteForce), 0U);
  const ToolResult& after = driver.settle(over(1.2, -0.006));
  EXPECT_EQ(after.flags, 0U);
  EXPECT_EQ(vec(after.force), Vec3::Zero());
}

}  // namespace

TEST(Poke, FastAndDeepItPushesOnlyWithinTheLimitAndLeavesNothing) {
  constexpr int kWithinTheRamp = 0, kAfterIt = 40;  // ticks
  for (const double mu : {0.0, 0.3, kInfinity})
    for (const double slant : {0.0, 0.5, 1.0}) {
      expectPushesOnlyAndLeavesNothing(withFriction(mu), slant, kWithinTheRamp);
      for (const DevicePreset& preset : devicePresets()) {
        StepConfig config = withFriction(mu);
        apply(preset, config);
        expectPushesOnlyAndLeavesNothing(config, slant, kAfterIt);
      }
    }
}

TEST(Poke, ASecondContactRemembersNothingOfTheFirst) {
  constexpr double kClear = -0.003, kDeep = 0.003;  // m
  for (const double apart : {0.05, 0.4}) {          // rad
    Driver twice(roundOrgan()), once(roundOrgan());
    Felt first, second, alone;
    wait(twice, over(0.0, kClear), 40, first);
    go(twice, over(0.0, kClear), over(0.0, kDeep), 0.1, first);
    go(twice, over(0.0, kDeep), over(0.0, kClear), 0.5, first);
    go(twice, over(0.0, kClear), over(apart, kClear), 1.0, first);
    ASSERT_EQ(first.changes, 2);
    second.last = first.last;
    go(twice, over(apart, kClear), over(apart, kDeep), 0.1, second);
    once.settle(over(apart, kClear));
    go(once, over(apart, kClear), over(apart, kDeep), 0.1, alone);
    EXPECT_GT(alone.last.norm(), 1.0);
    EXPECT_LT((second.last - alone.last).norm(), 1e-9);
    EXPECT_LT(second.largest_step, 1.5 * alone.largest_step);
    EXPECT_EQ(second.flags & ~kOrdinary, 0U);
    EXPECT_EQ(first.pulls + second.pulls, 0);
  }
}

TEST(Poke, AToolThatStartsInsideIsPushedOutTheNearestWayAndFreeOnceItIsOut) {
  for (const double depth : {0.001, 0.005, 0.02, 0.04})  // m, of the tip; the organ's middle is 0.055 deep
    for (const double mu : {0.0, 0.3}) {
      SCOPED_TRACE(::testing::Message() << "friction " << mu << ", " << depth << " m deep");
      const StepConfig config = withFriction(mu);
      Driver driver(roundOrgan(), config);
      const Vec3 inside = over(0.3, depth), outside = over(0.3, -0.002);
      Felt felt;
      wait(driver, inside, 40, felt);
      EXPECT_GT(felt.last.norm(), 0.9 * std::min(config.force_limit, 450.0 * depth));
      EXPECT_GT(felt.last.normalized().dot(inside.normalized()), 0.95);
      go(driver, inside, outside, 0.2, felt);
      const double turn = depth > 0.03 ? 2.0 : 1.0;  // near the middle an anchor may snap to the other side
      EXPECT_LT(felt.largest_step, turn * config.force_limit / 25.0) << "the ramp, or the way out";
      EXPECT_LE(felt.largest, config.force_limit * (1.0 + 1e-12));
      EXPECT_EQ(felt.changes, 2);
      EXPECT_EQ(felt.pulls, 0);
      const ToolResult& after = driver.settle(outside);
      EXPECT_EQ(after.flags, 0U);
      EXPECT_EQ(vec(after.force), Vec3::Zero());
    }
}

TEST(Poke, ForceNeverPullsOnARandomWay) {
  for (const double mu : {0.0, 0.05, 0.3, 1.0}) {
    Driver driver(roundOrgan(), withFriction(mu));
    unsigned seed = 1;
    const auto random = [&] { return (seed = seed * 1664525U + 1013904223U) / 4294967296.0 - 0.5; };
    Vec3 c = over(0.0, -0.003), velocity = Vec3::Zero();
    std::array<int, 3> ticks{};  // by state
    ContactState before = ContactState::kFree;
    Vec3 anchor = Vec3::Zero();
    for (int ms = 0; ms < 5000; ++ms) {
      velocity = 0.98 * velocity + 0.02 * Vec3(random(), random(), random());
      c += 0.004 * velocity + 0.002 * (over(0.0, 0.001) - c);
      const ToolResult& r = driver.at(c);
      ASSERT_GE(vec(r.force).dot(normalAt(roundOrgan(), r)), -1e-9 * vec(r.force).norm())
          << mu << ", " << ms << " ms, state " << r.state;
      const auto state = static_cast<ContactState>(r.state);
      if (state == ContactState::kStick && before != ContactState::kFree) {
        ASSERT_EQ(anchor, vec(r.anchor)) << "a stuck anchor does not move";
      }
      before = state;
      anchor = vec(r.anchor);
      ++ticks[r.state];
    }
    EXPECT_GT(ticks[1] + ticks[2], 1000) << mu;
    if (std::isfinite(mu)) {
      EXPECT_GT(ticks[2], 100) << mu;
    }
  }
}

}  // namespace palpate::testing
