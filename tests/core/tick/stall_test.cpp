// SPDX-License-Identifier: Apache-2.0
// A loop that stood still: no ramp is over when it goes on.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <vector>

#include "../round_organ.h"

namespace palpate::testing {

namespace {

constexpr std::int64_t kMs = 1'000'000;  // ns

/// Force and field, tick by tick after a stall of so many ns, at one place. @return largest step of the force
double steepestAfter(Driver& driver, std::int64_t stall_ns, const Vec3& c, float& field_step) {
  Vec3 last = vec(driver.result().tools[0].force);
  double most = 0.0;
  field_step = 0.0F;
  std::vector<float> before(driver.field().begin(), driver.field().end());
  driver.input().dt_ns = stall_ns;
  for (int ms = 0; ms < 60; ++ms) {
    const Vec3 now = vec(driver.at(c).force);
    most = std::max(most, (now - last).norm());
    last = now;
    const auto field = driver.field();
    for (std::size_t i = 0; i < field.size(); ++i)
      field_step = std::max(field_step, std::abs(field[i] - before[i]));
    before.assign(field.begin(), field.end());
    driver.input().dt_ns = kMs;
  }
  return most;
}

}  // namespace

TEST(Stall, AToolThatIsDeepAfterwardsIsEngagedByARamp) {
  for (const double start : {-0.002, 0.001}) {  // free before, and in contact before
    for (const std::int64_t stall : {12 * kMs, 30 * kMs, 90 * kMs, 5000 * kMs}) {
      Driver driver(roundOrgan());
      for (double z = -0.002; z < start; z += 5e-5) driver.at(above(z));
      driver.settle(above(start));
      float field_step = 0.0F;
      const double step = steepestAfter(driver, stall, above(0.005), field_step);
      const double full = vec(driver.result().tools[0].force).norm();
      ASSERT_GT(full, 2.0);
      EXPECT_LE(step, full * 2.1 / 30.0) << start << " m, " << stall / kMs << " ms: two ms of ramp_time";
      EXPECT_LE(field_step, 0.005F * 2.1F / 30.0F * 1.5F) << start << " m, " << stall / kMs << " ms";
    }
  }
}

TEST(Stall, OfATickWithoutAGoodPoseIsNotForgotten) {
  Driver driver(roundOrgan());
  for (double z = -0.002; z < 0.001; z += 5e-5) driver.at(above(z));
  driver.settle(above(0.001));
  const Vec3 held = vec(driver.result().tools[0].force);
  driver.input().dt_ns = 19 * kMs;
  driver.at(Vec3::Constant(std::numeric_limits<double>::quiet_NaN()));
  driver.input().dt_ns = kMs;
  EXPECT_LT((vec(driver.at(above(0.005)).force) - held).norm(), 0.15);
}

TEST(Stall, AnAbsurdPeriodGivesABoundedForceAndNoStaleOne) {
  for (const std::int64_t period : {std::int64_t{0}, -kMs, std::numeric_limits<std::int64_t>::min(),
                                    std::numeric_limits<std::int64_t>::max()}) {
    Driver driver(roundOrgan());
    driver.input().period_ns = period;
    for (double z = -0.002; z < 0.003; z += 5e-5) driver.at(above(z));
    const double before = vec(driver.settle(above(0.003)).force).norm();
    if (period <= 0) {
      EXPECT_GT(before, 0.5) << "1 ms";
    }
    float field_step = 0.0F;
    EXPECT_LE(steepestAfter(driver, 30 * kMs, above(0.003), field_step), 1e-9);
    EXPECT_EQ(vec(driver.at(above(0.003), 60 * kMs).force).norm(), 0.0) << period;
  }
}

TEST(Stall, ShorterThanTenPeriodsIsAnsweredByTheModel) {
  Driver driver(roundOrgan()), even(roundOrgan());
  for (Driver* one : {&driver, &even}) {
    for (double z = -0.002; z < 0.002; z += 5e-5) one->at(above(z));
    one->settle(above(0.002));
  }
  driver.input().dt_ns = 9 * kMs;
  EXPECT_EQ(driver.at(above(0.0025)).force, even.at(above(0.0025)).force);
  EXPECT_EQ(driver.result().tools[0].flags & kRamping, 0U);
}

TEST(Stall, LiveParametersGoOnByTwoPeriods) {
  Driver driver(roundOrgan());
  driver.at(above(-0.002));
  driver.input().has_settings = 1;
  driver.input().settings[0].live = liveParameters(StepConfig{});
  driver.input().settings[0].live.friction = 1.3;
  driver.input().dt_ns = 90 * kMs;
  driver.at(above(-0.002));
  EXPECT_NEAR(driver.work().live().friction, 0.3 + 1.0 * 2.0 / 100.0, 1e-12);
}

TEST(Stall, StalenessIsThePosesAgeAllTheSame) {
  Driver driver(roundOrgan());
  for (double z = -0.002; z < 0.002; z += 5e-5) driver.at(above(z));
  driver.settle(above(0.002));
  driver.input().dt_ns = 60 * kMs;
  EXPECT_EQ(vec(driver.at(above(0.002), 60 * kMs).force), Vec3::Zero());
}

}  // namespace palpate::testing
