// SPDX-License-Identifier: Apache-2.0
#include "core/devices/path/path.h"

#include <gtest/gtest.h>

#include <stdexcept>

namespace palpate::device {
namespace {

const Path& sample() {
  static const Path path(
      {0, 0, 0}, {{{0.01, 0, 0}, 0.5, "there"}, {{0.01, 0, 0}, 0.2, "pause"}, {{0, 0.02, 0}, 1.0, "back"}});
  return path;
}

TEST(MinimumJerk, StartsAndEndsAtRest) {
  const double h = 1e-4;
  EXPECT_EQ(minimumJerk(0.0), 0.0);
  EXPECT_EQ(minimumJerk(1.0), 1.0);
  EXPECT_EQ(minimumJerk(-3.0), 0.0);
  EXPECT_EQ(minimumJerk(7.0), 1.0);
  EXPECT_DOUBLE_EQ(minimumJerk(0.5), 0.5);
  EXPECT_NEAR(minimumJerk(h) / h, 0.0, 1e-6);                                           // velocity
  EXPECT_NEAR((minimumJerk(2 * h) - 2 * minimumJerk(h)) / (h * h), 0.0, 60.0 * 2 * h);  // acceleration: 60 x
  EXPECT_NEAR((1.0 - minimumJerk(1.0 - h)) / h, 0.0, 1e-6);
}

TEST(Path, PassesItsTargets) {
  EXPECT_EQ(sample().at(-1.0), (Point{0, 0, 0}));
  EXPECT_EQ(sample().at(0.5), (Point{0.01, 0, 0}));
  EXPECT_EQ(sample().at(0.6), (Point{0.01, 0, 0}));
  EXPECT_NEAR(length(sample().at(1.7) - Point{0, 0.02, 0}), 0.0, 1e-15);
  EXPECT_EQ(sample().at(99.0), (Point{0, 0.02, 0}));
  EXPECT_EQ(sample().legAt(0.6), "pause");
}

TEST(Path, VelocityAndAccelerationHaveNoJump) {
  const double h = 1e-3;
  // Bounds of one minimum-jerk leg: speed 1.875 L/T, acceleration 5.78 L/T^2, jerk 60 L/T^3.
  const double jerk = 60.0 * 0.0224 / 1.0 + 60.0 * 0.01 / 0.125;
  for (double t = 0.0; t < sample().seconds(); t += h) {
    const auto accelerationAt = [&](double s) {
      return (1.0 / (h * h)) * (sample().at(s + h) - 2.0 * sample().at(s) + sample().at(s - h));
    };
    EXPECT_LE(length(accelerationAt(t + h) - accelerationAt(t)), 1.01 * jerk * h) << t;
  }
}

TEST(Path, StretchingKeepsTheWay) {
  const Path slow = sample().stretchedTo(3.4);
  EXPECT_NEAR(slow.seconds(), 3.4, 1e-12);
  for (double t = 0.0; t < 1.7; t += 0.05) EXPECT_NEAR(length(slow.at(2.0 * t) - sample().at(t)), 0.0, 1e-12);
}

TEST(Path, RejectsALegWithoutTime) {
  try {
    const Path path({0, 0, 0}, {{{1, 0, 0}, 0.0, "jump"}});
    FAIL() << "a leg of 0 s was accepted";
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(), "leg 'jump' takes 0.000000 s, expected above 0");
  }
  EXPECT_THROW(Path({0, 0, 0}, {}), std::invalid_argument);
}

}  // namespace
}  // namespace palpate::device
