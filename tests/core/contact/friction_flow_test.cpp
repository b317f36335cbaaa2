// SPDX-License-Identifier: Apache-2.0
// The way that friction and viscosity let a tip go in one tick.
#include "core/contact/friction_flow.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace palpate::testing {

namespace {

/// Stiff in one direction, soft in the other.
Mat2 stiffness(double angle, double soft, double stiff) {
  const Vec2 u(std::cos(angle), std::sin(angle)), v(-u.y(), u.x());
  return soft * u * u.transpose() + stiff * v * v.transpose();
}

}  // namespace

TEST(FrictionFlow, WhatIsLeftOfTheForceOpposesTheWayAndIsAllThatHolds) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  for (int trial = 0; trial < 500; ++trial) {
    const Mat2 A = stiffness(6.0 * uniform(random), 100.0, 100.0 + 4000.0 * uniform(random));
    const Vec2 T(uniform(random) - 0.5, uniform(random) - 0.5);  // N
    Holding holding;
    holding.friction = 0.3 * uniform(random);
    holding.drag = 2000.0 * uniform(random);
    holding.free_way = 1e-3 * uniform(random);
    const Vec2 y = wayAgainst(holding, T, A);
    if (T.norm() <= holding.friction) {
      EXPECT_EQ(y, Vec2(Vec2::Zero())) << "it sticks";
      continue;
    }
    EXPECT_LT((T - A * y - holding.at(y) * y.normalized()).norm(), 1e-6 * T.norm());
  }
}

TEST(FrictionFlow, FrictionThatGrowsOnTheWayIsFoundWithIt) {
  Holding holding;
  holding.friction = 0.02;
  holding.growth = {60.0, -40.0};  // N/m: mu times a stiffness
  const Mat2 A = stiffness(0.4, 300.0, 2000.0);
  const Vec2 T(0.1, 0.05), y = wayAgainst(holding, T, A);
  EXPECT_LT((T - A * y - holding.at(y) * y.normalized()).norm(), 1e-6 * T.norm());
}

TEST(FrictionFlow, ViscosityBoundsTheWayOfWhatHardlyHolds) {
  Holding holding;
  holding.drag = 2000.0;
  holding.free_way = 1e-4;
  const Vec2 y = wayAgainst(holding, {0.1, 0.0}, stiffness(0.0, 1.0, 1.0));  // 100 mm without it
  EXPECT_NEAR(y.norm(), 1.5e-4, 1e-6);
}

}  // namespace palpate::testing
