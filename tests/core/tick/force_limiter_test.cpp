// SPDX-License-Identifier: Apache-2.0
#include "core/tick/force_limiter.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace palpate {

namespace {

LimiterInput pushing(const Vec3& force) {
  LimiterInput in;
  in.force = force;
  in.dt = 0.001;
  return in;
}

std::string complaint(const StepConfig& config) {
  try {
    check(config);
    return {};
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
}

}  // namespace

TEST(ForceLimiter, PassesSmallForcesUnchanged) {
  const ForceLimiter limiter(StepConfig{});
  Rendering memory;
  const LimitedForce out = limiter.limit(pushing(Vec3(0.1, 0.2, 3.0)), memory);
  EXPECT_EQ(out.force, Vec3(0.1, 0.2, 3.0));
  EXPECT_EQ(out.flags, 0U);
}

TEST(ForceLimiter, NothingButZeroStandsFiftyMillisecondsAfterTheLastPose) {
  const ForceLimiter limiter(StepConfig{});
  for (const double period : {0.0001, 0.001, 0.0033, 0.02}) {
    for (const double phase : {0.0, 0.13, 0.5, 0.97}) {  // the ages lie off the grid of 50 ms
      Rendering memory;
      LimiterInput in = pushing(Vec3(0.0, 0.0, 1.0));
      in.dt = in.period = period;
      for (in.age = phase * period; in.age < 0.1; in.age += period) {
        const Vec3 force = limiter.limit(in, memory).force;
        if (in.age + period > 0.050) {
          ASSERT_EQ(force, Vec3::Zero()) << "sent at " << in.age << " s, period " << period;
        }
        if (in.age + period < 0.020) {
          ASSERT_EQ(force, in.force) << "sent at " << in.age << " s, period " << period;
        }
      }
    }
  }
}

TEST(ForceLimiter, CutsLongForcesAndTheirStiffness) {
  const ForceLimiter limiter(StepConfig{});
  Rendering memory;
  LimiterInput in = pushing(Vec3(0.0, 0.0, 10.0));
  in.stiffness = -500.0 * Mat3::Identity();
  const LimitedForce out = limiter.limit(in, memory);
  EXPECT_NEAR(out.force.norm(), 3.3, 1e-12);
  EXPECT_EQ(out.flags & kForceLimited, kForceLimited);
  EXPECT_NEAR(out.stiffness(2, 2), 0.0, 1e-12) << "pressing harder changes nothing";
  EXPECT_NEAR(out.stiffness(0, 0), -165.0, 1e-9);
}

TEST(ForceLimiter, BlendsAJumpConvexly) {
  const ForceLimiter limiter(StepConfig{});
  Rendering memory;
  (void)limiter.limit(pushing(Vec3(0.0, 0.0, 2.0)), memory);
  LimiterInput in = pushing(Vec3(0.0, 0.0, 0.5));
  in.jumped = true;
  double last = 2.0;
  for (int ms = 0; ms < 40; ++ms) {
    const double now = limiter.limit(in, memory).force.z();
    EXPECT_LE(now, last);
    EXPECT_GE(now, last - 0.06);
    EXPECT_GE(now, 0.5);
    last = now;
    in.jumped = false;
  }
  EXPECT_EQ(last, 0.5);
}

TEST(ForceLimiter, AFallingForceLimitIsKeptWhateverTheRateLimit) {
  const ForceLimiter limiter(StepConfig{});
  Rendering memory;
  (void)limiter.limit(pushing(Vec3(0.0, 0.0, 3.3)), memory);
  LimiterInput in = pushing(Vec3(0.0, 0.0, 3.3));
  in.force_rate_limit = 10.0;
  for (int ms = 1; ms <= 100; ++ms) {
    in.force_limit = 3.3 - 0.028 * ms;
    in.held = ms > 50;  // a force that stands in for a new one is cut as well
    const LimitedForce out = limiter.limit(in, memory);
    ASSERT_LE(out.force.norm(), in.force_limit * (1.0 + 1e-9)) << ms << " ms";
    ASSERT_NE(out.flags & kForceLimited, 0U);
  }
  EXPECT_NEAR(memory.rendered.norm(), 0.5, 1e-9);
}

TEST(ForceLimiter, HeldForceHasNoStiffness) {
  const ForceLimiter limiter(StepConfig{});
  Rendering memory;
  (void)limiter.limit(pushing(Vec3(0.0, 0.0, 2.0)), memory);
  LimiterInput in = pushing(Vec3::Constant(std::numeric_limits<double>::quiet_NaN()));
  in.stiffness.setConstant(1e6);
  in.held = true;
  in.age = 0.01;
  const LimitedForce out = limiter.limit(in, memory);
  EXPECT_EQ(out.force, Vec3(0.0, 0.0, 2.0));
  EXPECT_EQ(out.stiffness, Mat3::Zero());
}

TEST(StepConfig, DefaultsAreInRange) {
  EXPECT_EQ(complaint({}), "");
}

TEST(StepConfig, NamesTheFirstBadField) {
  EXPECT_EQ(complaint({.tip_radius = 0.06}), "StepConfig.tip_radius is 0.06, expected 0 to 0.05 m");
  EXPECT_EQ(complaint({.tip_radius = std::nan("")}), "StepConfig.tip_radius is nan, expected 0 to 0.05 m");
  EXPECT_EQ(complaint({.force_limit = 0.0}),
            "StepConfig.force_limit is 0, expected 0.01 to 50 N or infinity");
  EXPECT_EQ(complaint({.stale_timeout = 0.06}),
            "StepConfig.stale_timeout is 0.06, expected 0.001 to 0.045 s");
  EXPECT_EQ(complaint({.zero_after = 0.2}), "StepConfig.zero_after is 0.2, expected 0.021 to 0.05 s");
  EXPECT_EQ(complaint({.ramp_time = -0.1}), "StepConfig.ramp_time is -0.1, expected 0 to 1 s");
  EXPECT_EQ(complaint({.quaternion_tolerance = 1.0}),
            "StepConfig.quaternion_tolerance is 1, expected 1e-09 to 0.1 (no unit)");
  EXPECT_EQ(
      complaint({.coupling_stiffness = 300.0, .coupling_damping = 100.0}),
      "StepConfig.coupling_damping is 100, expected at most 1.5 N s/m with coupling_stiffness 300 N/m: 5 "
      "ms of it");
}

TEST(StepConfig, DampingIsBoundedByTheCouplingsStiffness) {
  for (const double stiffness : {1.0, 300.0, 1000.0, 12345.6}) {
    const double most = stiffness / 200.0;
    EXPECT_EQ(complaint({.coupling_stiffness = stiffness, .coupling_damping = std::min(most, 100.0)}), "");
    EXPECT_NE(complaint({.coupling_stiffness = stiffness, .coupling_damping = 1.01 * most}), "") << stiffness;
  }
  EXPECT_EQ(complaint({.coupling_damping = 100.0}), "") << "without a coupling there is none";
}

TEST(ForceLimiter, HandsOverWithinTheRampAndTheRateLimit) {
  for (const double rate : {std::numeric_limits<double>::infinity(), 20.0}) {
    const ForceLimiter limiter(StepConfig{});
    Rendering memory;
    LimiterInput in = pushing(Vec3(0.0, 0.6, 0.8));
    (void)limiter.limit(in, memory);
    in.force_rate_limit = rate;
    in.hands_over = in.held = true;
    double last = 1.0;
    int ticks = 0;
    for (; last > 0.0 && ticks < 1000; ++ticks) {
      const LimitedForce out = limiter.limit(in, memory);
      const double size = out.force.norm();
      ASSERT_LE(last - size, std::min(rate * in.dt, in.dt / StepConfig{}.ramp_time) * 1.000001);
      ASSERT_LT(size, last);
      EXPECT_NE(out.flags & kModelChanging, 0U);
      EXPECT_EQ(out.flags & kShuttingDown, 0U);
      last = size;
    }
    EXPECT_NEAR(ticks, std::isinf(rate) ? 30 : 50, 1);
  }
}

TEST(ForceLimiter, PosesThatComeBackWhileTheForceEndsDoNotRaiseIt) {
  for (const bool hands_over : {true, false}) {
    const ForceLimiter limiter(StepConfig{.ramp_time = 0.2});
    Rendering memory;
    LimiterInput in = pushing(Vec3(0.0, 0.6, 0.8));
    in.period = in.dt;
    (void)limiter.limit(in, memory);
    in.hands_over = hands_over;
    in.shutting_down = !hands_over;
    in.held = true;
    double last = 1.0;
    for (int ms = 1; ms <= 100; ++ms) {
      in.age = ms > 5 && ms < 40 ? 1e-3 * (ms - 5) : 0.0;  // none came for 35 ms
      const double size = limiter.limit(in, memory).force.norm();
      ASSERT_LE(size, last) << ms << " ms";
      last = size;
    }
    EXPECT_GT(last, 0.0) << "it fades on from where the poses left it";
  }
}

}  // namespace palpate
