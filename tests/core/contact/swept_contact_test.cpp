// SPDX-License-Identifier: Apache-2.0
// Poses so far apart that a tool is on the other side of a plate before it was ever seen to touch it.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "../thin_plate.h"
#include "palpate/testing/sanitizers.h"

namespace palpate::testing {

namespace {

constexpr double kHalf = 0.002;     // of the plate's thickness, m
constexpr double kFastest = 1.9;    // m/s, below the speed limit
constexpr double kSpread = 0.03;    // m; the plate's rim is at 0.05 m
constexpr double kOutside = 0.012;  // m from the middle: clear of the plate, with the largest tip

const MetaModel& plate() {
  static const MetaModel model = thinPlate(kHalf);
  return model;
}

StepConfig configOf(double radius, double friction, double coupling = kInfinity) {
  StepConfig config;
  config.tip_radius = radius;
  config.friction = friction;
  config.coupling_stiffness = coupling;
  return config;
}

/// A hand whose poses come some milliseconds apart; ticks go on at 1 kHz.
class SparseHand {
 public:
  SparseHand(const StepConfig& config, int spacing_ms) : spacing_(spacing_ms), driver_(plate(), config) {}

  /// One pose, and the ticks until the next. @param each  is given the result of each tick
  template <class Each>
  void to(const Vec3& c, Each&& each) {
    for (std::int64_t ms = 0; ms < spacing_; ++ms) each(driver_.at(c, ms * 1'000'000));
  }
  [[nodiscard]] double reach() const { return kFastest * 1e-3 * spacing_; }
  Driver& driver() { return driver_; }
  /// From now on another tool holds the plate down in the middle. @param depth  of that one's tip, m
  void press(double depth) {
    const double top = kHalf + StepConfig{}.tip_radius;
    driver_.input().tools[1].present = 1;
    for (double z = 1e-3; z > -depth; z -= 1e-4) {
      driver_.input().tools[1].position = {0.0, 0.0, top + z};
      driver_.tick();
    }
  }

 private:
  int spacing_;
  Driver driver_;
};

}  // namespace

TEST(SweptContact, AToolThatIsThroughAPlateBeforeItWasSeenToTouchIsPushedBackToItsSide) {
  for (const double side : {1.0, -1.0})
    for (const int spacing : {1, 2, 4, 8, 20})
      for (const double phase : {0.0, 0.2, 0.4, 0.6, 0.8}) {
        SCOPED_TRACE(::testing::Message() << "side " << side << ", poses " << spacing << " ms apart");
        SparseHand hand(configOf(0.005, 0.3), spacing);
        double least = 0.0, most = 0.0;
        for (double z = 0.02 + phase * hand.reach(); z > -0.05; z -= hand.reach())
          hand.to(Vec3(0.003, 0.002, side * z), [&](const ToolResult& r) {
            least = std::min(least, side * r.force[2]);
            most = std::max(most, side * r.force[2]);
          });
        EXPECT_GE(least, 0.0) << "N, drawn on through the plate";
        EXPECT_GT(most, 1.0);
        EXPECT_NEAR(side * hand.driver().result().tools[0].anchor[2], kHalf, 1e-9);
      }
}

namespace {

/// Flies to and fro over the plate's middle part, through it at any speed and slant, and says what went wrong.
class Flight {
 public:
  Flight(const StepConfig& config, int spacing_ms, unsigned seed)
      : hand_(config, spacing_ms), random_(seed), position_(target()), side_(seed % 2 == 0 ? 1.0 : -1.0) {
    position_.z() = side_ * kOutside;
    hand_.to(position_, [](const ToolResult&) {});
  }
  /// Another tool moves the plate. @param depth  m
  void press(double depth) {
    hand_.press(depth);
    moved_ = depth;
  }
  void fly(int legs) {
    for (int leg = 0; leg < legs; ++leg) {
      const Vec3 to = target(), from = position_;
      const double step = hand_.reach() * (0.05 + 0.95 * std::abs(uniform()));
      const int poses = static_cast<int>(std::ceil((to - from).norm() / step));
      for (int i = 1; i <= poses; ++i) move(from + (to - from) * i / poses);
      if (::testing::Test::HasFailure()) return;
    }
  }

 private:
  double uniform() { return std::uniform_real_distribution<double>(-1.0, 1.0)(random_); }
  Vec3 target() { return {kSpread * 0.7 * uniform(), kSpread * 0.7 * uniform(), kSpread * uniform()}; }
  void move(const Vec3& c) {
    position_ = c;
    hand_.to(c, [&](const ToolResult& r) { judge(r); });
  }
  void judge(const ToolResult& r) {
    ASSERT_GE(side_ * r.force[2], -1e-9) << "N, drawn on through the plate, at " << position_.transpose();
    ASSERT_EQ(r.flags & kPoseJump, 0U);
    if (side_ * position_.z() > -moved_) return;
    ASSERT_NE(r.state, 0U) << "through, and not held, at " << position_.transpose();
    ASSERT_NEAR(side_ * r.anchor[2], kHalf, 1e-9) << "held on the wrong side";
  }

  SparseHand hand_;
  std::mt19937 random_;
  Vec3 position_;
  double moved_{0.0};  // what the plate may have been moved, m
  double side_;        // where it is clear of the plate at first: 1 above, -1 below
};

}  // namespace

TEST(SweptContact, NoWayThroughAPlateBelowTheSpeedLimitIsOpen) {
  unsigned seed = 0;
  for (const double radius : {0.0, 0.0005, 0.005})
    for (const double friction : {0.0, 0.05, 0.3, kInfinity})
      for (const double coupling : {kInfinity, 300.0})
        for (const int spacing : {1, 3, 7, 20}) {
          SCOPED_TRACE(::testing::Message()
                       << "tip of " << radius << " m, friction " << friction << ", coupling " << coupling
                       << ", poses " << spacing << " ms apart, seed " << seed);
          Flight flight(configOf(radius, friction, coupling), spacing, ++seed);
          flight.fly(12);
          ASSERT_FALSE(HasFailure());
        }
}

TEST(SweptContact, NoWayThroughAPlateThatAnotherToolHoldsDownIsOpenEither) {
  unsigned seed = 0;
  for (const double radius : {0.0005, 0.005})
    for (const double friction : {0.0, 0.3, kInfinity})
      for (const double coupling : {kInfinity, 300.0})
        for (const int spacing : fewUnderSanitizers(1, {4, 1, 20})) {
          SCOPED_TRACE(::testing::Message()
                       << "tip of " << radius << " m, friction " << friction << ", coupling " << coupling
                       << ", poses " << spacing << " ms apart, seed " << seed);
          Flight flight(configOf(radius, friction, coupling), spacing, ++seed);
          flight.press(0.006);
          flight.fly(12);
          ASSERT_FALSE(HasFailure());
        }
}

namespace {

constexpr double kBeyondMiddle = -0.001;  // z of the tip's centre, m, where the lower side is the nearest

/// Presses from above until the lower side is the nearest, and waits.
void pressBeyondTheMiddle(Driver& driver) {
  for (double z = kOutside; z > kBeyondMiddle; z -= 1e-4) driver.at(Vec3(0.003, 0.002, z));
  driver.settle(Vec3(0.003, 0.002, kBeyondMiddle));
}

void fallSilent(Driver& driver, const Vec3& c) {
  for (std::int64_t ms = 1; ms < 200; ++ms) driver.at(c, ms * 1'000'000);
}

}  // namespace

TEST(SweptContact, AToolThatLeapsStartsAgainOnTheNearestSide) {
  Driver driver(plate());
  pressBeyondTheMiddle(driver);
  EXPECT_GT(driver.result().tools[0].force[2], 1.0);
  const Vec3 elsewhere(0.015, 0.002, kBeyondMiddle);
  EXPECT_NE(driver.at(elsewhere).flags & kPoseJump, 0U);
  const ToolResult& r = driver.settle(elsewhere);
  EXPECT_NEAR(r.anchor[2], -kHalf, 1e-9);
  EXPECT_LT(r.force[2], -1.0);
}

TEST(SweptContact, AfterASilenceAToolThatIsStillInsideKeepsItsSide) {
  Driver driver(plate());
  pressBeyondTheMiddle(driver);
  const Vec3 c(0.003, 0.002, kBeyondMiddle);
  fallSilent(driver, c);
  EXPECT_EQ(driver.result().tools[0].state, 0U);
  for (int ms = 0; ms < 40; ++ms) ASSERT_GE(driver.at(c).force[2], 0.0);
  EXPECT_GT(driver.result().tools[0].force[2], 1.0);
}

TEST(SweptContact, AfterASilenceAToolThatIsClearIsFreeHoweverItGotThere) {
  for (const std::int64_t silent : {30, 200}) {
    Driver driver(plate());
    pressBeyondTheMiddle(driver);
    for (std::int64_t ms = 1; ms < silent; ++ms) driver.at(Vec3(0.003, 0.002, kBeyondMiddle), ms * 1'000'000);
    const Vec3 below(0.003, 0.002, -kOutside);
    EXPECT_EQ(driver.at(below).state, 0U) << silent;
    EXPECT_EQ(vec(driver.settle(below).force), Vec3::Zero()) << silent;
    for (double z = -kOutside; z < -0.006; z += 1e-4) driver.at(Vec3(0.003, 0.002, z));
    EXPECT_LT(driver.settle(Vec3(0.003, 0.002, -0.006)).force[2], -0.2) << "touched from below";
  }
}

TEST(SweptContact, AToolThatWasTakenFreeAfterLateTicksIsLetGoByARamp) {
  constexpr std::int64_t kLate = 5'000'000;  // ns; no stall yet
  Driver driver(plate());
  pressBeyondTheMiddle(driver);
  const Vec3 c(0.003, 0.002, kBeyondMiddle);
  for (std::int64_t ms = 1; ms <= 20; ++ms) driver.at(c, ms * 1'000'000);  // old, but not stale
  const double before = vec(driver.result().tools[0].force).norm();
  driver.input().dt_ns = kLate;
  const ToolResult& r = driver.at(Vec3(0.003, 0.002, -kOutside));
  EXPECT_EQ(r.state, 0U);
  EXPECT_NE(r.flags & kRamping, 0U);
  EXPECT_GT(vec(r.force).norm(), 0.5 * before) << "N, of " << before;
}

TEST(SweptContact, InALoopOfAFewHertzNoWayThroughAPlateIsOpenEither) {
  for (const std::int64_t period : {25'000'000, 40'000'000}) {  // ns
    Driver driver(plate());
    driver.input().dt_ns = driver.input().period_ns = period;
    const double step = kFastest * 1e-9 * double(period);
    for (double z = 0.02; z > 0.02 - 2.5 * step; z -= step) driver.at(Vec3(0.003, 0.002, z));
    const ToolResult& r = driver.result().tools[0];
    EXPECT_NE(r.state, 0U) << period;
    EXPECT_NEAR(r.anchor[2], kHalf, 1e-9) << period;
    EXPECT_GT(r.force[2], 0.1) << "N, pushed back to its side, " << period;
  }
}

}  // namespace palpate::testing
