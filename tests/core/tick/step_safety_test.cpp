// SPDX-License-Identifier: Apache-2.0
// What step() makes of poses that are late, of numbers that are none, and of its own end.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "../round_organ.h"
#include "tools/modelfile/write_model.h"

namespace palpate::testing {

namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

bool isFinite(const ToolResult& r) {
  return vec(r.force).allFinite() && vec(r.proxy).allFinite() && vec(r.anchor).allFinite() &&
         std::isfinite(r.stiffness[0] + r.stiffness[4] + r.stiffness[8]);
}

}  // namespace

TEST(Step, ForceStaysWithinTheLimitAndKeepsItsDirection) {
  StepConfig config;
  config.force_limit = 0.5;
  Driver driver(roundOrgan(), config), free(roundOrgan());
  press(driver, 0.004);
  press(free, 0.004);
  const ToolResult& r = driver.result().tools[0];
  EXPECT_EQ(r.flags & kForceLimited, kForceLimited);
  EXPECT_NEAR(vec(r.force).norm(), 0.5, 1e-12);
  EXPECT_LT(vec(r.force).normalized().cross(vec(free.result().tools[0].force).normalized()).norm(), 1e-9);
}

TEST(Step, StalePoseRampsToZeroWithinFiftyMilliseconds) {
  Driver driver(roundOrgan());
  press(driver, 0.003);
  const double full = vec(driver.result().tools[0].force).norm();
  double last = full;
  for (std::int64_t ms = 1; ms <= 60; ++ms) {
    const ToolResult& r = driver.at(above(0.003), ms * 1'000'000);
    const double size = vec(r.force).norm();
    EXPECT_LE(std::abs(size - last), full / 25.0) << ms << " ms: a step in the force";
    EXPECT_LE(size, last + 1e-12);
    EXPECT_EQ((r.flags & kStalePose) != 0, ms > 20) << ms << " ms";
    if (ms >= 50) {
      EXPECT_EQ(size, 0.0);
    }
    last = size;
  }
  EXPECT_EQ(driver.result().tools[0].state, 0U);
}

TEST(Step, RampEndsInTimeAtALowRateToo) {
  Driver driver(roundOrgan());
  press(driver, 0.003);
  driver.input().dt_ns = 25'000'000;
  driver.at(above(0.003), 25'000'000);
  EXPECT_EQ(vec(driver.at(above(0.003), 50'000'000).force).norm(), 0.0);
}

TEST(Step, ForceIsContinuousWhenAStalePoseComesBack) {
  for (const int silent : {30, 45, 80}) {
    for (const Vec3& back :
         {above(0.003), above(0.006), Vec3(above(0.004) + Vec3(0.003, 0.0, 0.0)), above(-0.01)}) {
      Driver driver(roundOrgan());
      press(driver, 0.003);
      for (int ms = 1; ms <= silent; ++ms) driver.at(above(0.003), ms * 1'000'000LL);
      Vec3 last = vec(driver.result().tools[0].force);
      for (int ms = 0; ms < 60; ++ms) {
        const Vec3 now = vec(driver.at(back).force);
        ASSERT_LE((now - last).norm(), 0.15) << silent << " ms silent, " << ms << " ms back";
        last = now;
      }
    }
  }
}

TEST(Step, NonFinitePoseIsNeverPassedOn) {
  Driver driver(roundOrgan());
  press(driver, 0.003);
  const Vec3 before = vec(driver.result().tools[0].force);
  for (int ms = 1; ms <= 60; ++ms) {
    for (double bad : {kNaN, std::numeric_limits<double>::infinity(), -1e300}) {
      driver.input().dt_ns = 333'333;
      const ToolResult& r = driver.at(Vec3(0.0, bad, 0.0));
      ASSERT_TRUE(isFinite(r));
      ASSERT_EQ(r.flags & kNonFinitePose, kNonFinitePose);
      if (ms < 18) {
        ASSERT_LT((vec(r.force) - before).norm(), 1e-12) << "a short glitch is held";
      }
      if (ms > 50) {
        ASSERT_EQ(vec(r.force).norm(), 0.0);
      }
    }
  }
  driver.input().dt_ns = 1'000'000;
  EXPECT_LT((vec(driver.settle(above(0.003)).force) - before).norm(), 1e-9) << "it recovers";
}

TEST(Step, NonUnitQuaternionIsAnsweredLikeAStalePose) {
  Driver driver(roundOrgan());
  press(driver, 0.003);
  for (const std::array<double, 4>& bad :
       {std::array{0.0, 0.0, 0.0, 0.0}, std::array{0.0, 0.0, 0.0, 1.5}, std::array{kNaN, 0.0, 0.0, 1.0}}) {
    driver.input().tools[0].orientation = bad;
    const ToolResult& r = driver.at(above(0.003));
    EXPECT_NE(r.flags & (kNonUnitQuaternion | kNonFinitePose), 0U);
    EXPECT_TRUE(isFinite(r));
  }
  for (int ms = 0; ms < 60; ++ms) driver.at(above(0.003));
  EXPECT_EQ(vec(driver.result().tools[0].force).norm(), 0.0);
  EXPECT_EQ(driver.result().tools[0].flags & kStalePose, kStalePose);
}

TEST(Step, OverflowInTheModelNeverComesOut) {
  modelfile::ModelData data = syntheticModel();
  for (double& f : data.contact_force) f *= 1e306;
  for (double& K : data.contact_stiffness) K *= 1e303;
  for (float& u : data.near_field) u = 3e38F;
  for (float& u : data.green_near) u = 3e38F;
  const TemporaryFile file("overflow.h5");
  modelfile::writeModel(file.path(), data);
  const MetaModel model = MetaModel::load(file.path());
  Driver driver(model);
  press(driver, 0.004);
  EXPECT_TRUE(isFinite(driver.result().tools[0]));
  EXPECT_EQ(driver.result().tools[0].flags & kNonFiniteForce, kNonFiniteForce);
  ASSERT_FALSE(driver.field().empty());
  for (const float u : driver.field()) ASSERT_TRUE(std::isfinite(u));
}

TEST(Step, OverflowInTheFieldAloneLeavesTheForceAndShowsNoField) {
  modelfile::ModelData data = syntheticModel();
  for (float& x : data.modes_X) x *= 1e30F;
  for (float& y : data.modes_Y) y *= 1e30F;
  for (float& y : data.green_Y) y *= 1e30F;
  const TemporaryFile file("field-overflow.h5");
  modelfile::writeModel(file.path(), data);
  const MetaModel model = MetaModel::load(file.path());
  Driver driver(model), sound(roundOrgan());
  press(driver, 0.004);
  press(sound, 0.004);
  EXPECT_EQ(driver.result().tools[0].flags, kInContact | kNonFiniteForce);
  EXPECT_EQ(driver.result().tools[0].force, sound.result().tools[0].force);
  EXPECT_EQ(driver.status(), StepStatus::kFlagged);
  ASSERT_FALSE(driver.field().empty());
  for (const float u : driver.field()) ASSERT_EQ(u, 0.0F);
}

TEST(Step, ShutdownFadesToZeroForGood) {
  Driver driver(roundOrgan());
  press(driver, 0.003);
  const double full = vec(driver.result().tools[0].force).norm();
  driver.input().shutting_down = 1;
  double last = full;
  for (int ms = 0; ms < 40; ++ms) {
    const ToolResult& r = driver.at(above(0.003 + 1e-4 * ms));
    EXPECT_EQ(r.flags & kShuttingDown, kShuttingDown);
    EXPECT_LE(vec(r.force).norm(), last);
    EXPECT_GE(vec(r.force).norm(), last - full / 25.0);
    last = vec(r.force).norm();
  }
  EXPECT_EQ(last, 0.0);
}

TEST(Step, ToolThatIsGoneIsForgotten) {
  Driver driver(roundOrgan());
  press(driver, 0.003);
  driver.input().tools[0].present = 0;
  driver.tick();
  EXPECT_GT(vec(driver.result().tools[0].force).norm(), 0.5) << "held first";
  for (int ms = 0; ms < 60; ++ms) driver.tick();
  EXPECT_EQ(driver.result().tools[0].flags, 0U);
  EXPECT_EQ(vec(driver.result().tools[0].force), Vec3::Zero());
}

}  // namespace palpate::testing
