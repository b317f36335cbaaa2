// SPDX-License-Identifier: Apache-2.0
// A part so thin that the nearest point of its surface flips to the other side under a tool that presses.
#include "../thin_plate.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace palpate::testing {

namespace {

constexpr double kHalfThickness = 0.001;  // m
constexpr double kStiffness = kPlateStiffness;

const MetaModel& thinnestPlate() {
  static const MetaModel model = thinPlate(kHalfThickness);
  return model;
}

/// A tip over the plate, `depth` below where it touches the upper side.
class Tip {
 public:
  Tip(double radius, double friction)
      : radius_(radius), friction_(friction), driver_(thinnestPlate(), configOf(radius, friction)) {
    driver_.settle(at(-0.001));
  }
  /// Beyond it the other side is the nearest, m deep.
  [[nodiscard]] double middle() const { return kHalfThickness + radius_; }
  [[nodiscard]] double friction() const { return friction_; }
  /// Goes down from above, a tenth of a millimetre a tick.
  void press(double deep) {
    for (double depth = -0.001; depth < deep; depth += 1e-4) to(depth);
  }
  const ToolResult& to(double depth, double sideways = 0.0) { return driver_.at(at(depth, sideways)); }
  const ToolResult& settle(double depth) { return driver_.settle(at(depth)); }

 private:
  static StepConfig configOf(double radius, double friction) {
    StepConfig config;
    config.tip_radius = radius;
    config.friction = friction;
    return config;
  }
  [[nodiscard]] Vec3 at(double depth, double sideways = 0.0) const {
    return {0.003 + sideways, 0.002, kHalfThickness + radius_ - depth};
  }
  double radius_, friction_;
  Driver driver_;
};

/// Each tip with each friction, before it has touched.
template <class Test>
void forEachTip(Test&& test) {
  for (const double radius : {0.0, 0.0005, 0.005})
    for (const double friction : {0.0, 0.3, std::numeric_limits<double>::infinity()}) {
      SCOPED_TRACE(::testing::Message() << "tip of " << radius << " m, friction " << friction);
      Tip tip(radius, friction);
      test(tip);
    }
}

}  // namespace

TEST(ThinPlate, PressedBeyondItsMiddleItPushesBackToTheSideOfEntry) {
  forEachTip([](Tip& tip) {
    double last = 0.0;
    for (double depth = -0.001; depth < tip.middle() + 0.0008; depth += 1e-4) {
      const ToolResult& r = tip.to(depth);
      ASSERT_NEAR(r.force[2], std::min(3.3, std::max(0.0, kStiffness * depth)), 1e-6) << depth;
      ASSERT_LE(std::abs(r.force[2] - last), 1.01e-4 * kStiffness) << depth << " m deep: a step";
      ASSERT_NEAR(r.anchor[2], kHalfThickness, 1e-9) << depth;
      last = r.force[2];
    }
    EXPECT_LT(thinnestPlate().surface().closestPoint(Vec3(0.003, 0.002, -1e-4)).position.z(), 0.0)
        << "it did flip";
  });
}

TEST(ThinPlate, DraggedAlongBeyondItsMiddleTheAnchorStaysOnTheSideOfEntry) {
  forEachTip([](Tip& tip) {
    const double deep = tip.middle() + 0.0005;
    tip.press(deep);
    Vec3 last = vec(tip.to(deep).force);
    for (double x = 0.0; x < 0.02; x += 5e-5) {
      const ToolResult& r = tip.to(deep, x);
      ASSERT_NEAR(r.anchor[2], kHalfThickness, 1e-9) << x;
      ASSERT_GT(r.force[2], 0.2 * kStiffness * deep) << x;
      ASSERT_LT((vec(r.force) - last).norm(), 1.01 * 5e-5 * kStiffness) << x << ": a step";
      last = vec(r.force);
    }
  });
}

TEST(ThinPlate, DrivenOffItsRimHalfwayToTheMiddleTheForceEndsWithoutAStep) {
  forEachTip([](Tip& tip) {
    constexpr double kWay = 5e-5;  // m in a tick
    const double most =
        std::isfinite(tip.friction()) ? 2.0 * kStiffness * kWay : 3.3 / 25.0;  // let go: a ramp
    const double deep = 0.5 * tip.middle();
    tip.press(deep);
    Vec3 last = vec(tip.to(deep).force);
    EXPECT_GT(last.z(), 0.9 * kStiffness * deep);
    for (double x = 0.0; x < 0.075; x += kWay) {
      const ToolResult& r = tip.to(deep, x);
      ASSERT_LT((vec(r.force) - last).norm(), most) << x;
      last = vec(r.force);
    }
    EXPECT_EQ(last, Vec3::Zero());
  });
}

// Without friction the anchor snaps round the rim to the other side, within a tick.
TEST(ThinPlate, DrivenOffItsRimBeyondItsMiddleTheForceTurnsWithoutAStep) {
  for (const double friction : {0.0, 0.05}) {
    Tip tip(0.005, friction);
    tip.press(0.0065);
    Vec3 last = vec(tip.to(0.0065).force);
    double lowest = 0.0;
    for (double x = 0.0; x < 0.075; x += 5e-5) {
      const Vec3 now = vec(tip.to(0.0065, x).force);
      // Turned round in a ramp, 6.6 N / 30 ms, while the anchor still goes on.
      ASSERT_LT((now - last).norm(), 3.3 / 10.0) << x << ", friction " << friction;
      last = now;
      lowest = std::min(lowest, now.z());
    }
    EXPECT_LT(lowest, -0.05) << "it did turn";
  }
}

namespace {

/// Down through the plate, far beyond, and back out. @param step  m in a tick
void pokeThrough(Tip tip, double step) {
  const double beyond = tip.middle() + 0.02;
  const auto to = [&](double depth) {
    const ToolResult& r = tip.to(depth);
    ASSERT_GE(r.force[2], 0.0) << depth << ": never towards the far side";
    ASSERT_LE(r.force[2], 3.3 + 1e-9) << depth;
    ASSERT_EQ(r.state != 0, depth > 0.0) << depth << ": held while it is below the side of entry";
    if (r.state != 0) {
      ASSERT_NEAR(r.anchor[2], kHalfThickness, 1e-9) << depth;
    }
  };
  double depth = -0.00103;
  for (; depth < beyond; depth += step) ASSERT_NO_FATAL_FAILURE(to(depth));
  EXPECT_NEAR(tip.settle(depth - step).force[2], 3.3, 1e-6) << "all that the device can";
  for (; depth > -0.001; depth -= step) ASSERT_NO_FATAL_FAILURE(to(depth + 1e-6));
  EXPECT_EQ(vec(tip.settle(-0.001).force), Vec3::Zero());
  EXPECT_EQ(tip.settle(-0.001).flags, 0U);
}

}  // namespace

TEST(ThinPlate, PokedRightThroughItIsPushedBackToTheSideOfEntryAndFreeThere) {
  forEachTip([](const Tip& tip) {
    for (const double step : {1e-4, std::min(2e-3, 0.8 * tip.middle())}) pokeThrough(tip, step);
  });
}

TEST(ThinPlate, TouchedFromTheOtherSideItPushesThere) {
  forEachTip([](Tip& tip) {
    const double below = 2.0 * tip.middle();  // where the tip touches the other side
    double x = 0.0, depth = -0.001;
    for (; x < 0.08; x += 1e-3) tip.to(depth, x);
    for (; depth < below + 0.001; depth += 1e-3) tip.to(depth, x);
    for (; x > 0.0; x -= 1e-3) tip.to(depth, x);
    for (; depth > below - 0.0005; depth -= 1e-4) tip.to(depth);
    const ToolResult& r = tip.settle(below - 0.0005);
    EXPECT_NEAR(r.force[2], -kStiffness * 0.0005, 1e-6);
    EXPECT_NEAR(r.anchor[2], -kHalfThickness, 1e-9);
  });
}

}  // namespace palpate::testing
