// SPDX-License-Identifier: Apache-2.0
#include "tools/program/svg_axis.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

namespace palpate::program {
namespace {

TEST(Axis, ALinearOneGoesFromTickToTick) {
  const Axis axis = makeAxis(0.3, 9.7, 100.0, 500.0, false);
  EXPECT_LE(axis.low, 0.3);
  EXPECT_GE(axis.high, 9.7);
  EXPECT_EQ(axis.px(axis.low), 100.0);
  EXPECT_EQ(axis.px(axis.high), 500.0);
  EXPECT_NEAR(axis.px((axis.low + axis.high) / 2.0), 300.0, 1e-9);
}

TEST(Axis, ALogarithmicOneHasItsPowersOfTenEvenlyApart) {
  const Axis axis = makeAxis(1.0, 1e4, 400.0, 0.0, true);
  EXPECT_EQ(axis.ticks.size(), 5U);
  EXPECT_NEAR(axis.px(100.0), 200.0, 1e-9);
  EXPECT_TRUE(std::isfinite(axis.px(0.0)));
  EXPECT_EQ(makeAxis(1.0, 10.0, 0.0, 1.0, true).ticks.size(), 4U);  // 1, 2, 5, 10
}

TEST(Axis, OneValueHasRoomAroundIt) {
  for (const bool log : {false, true}) {
    const Axis axis = makeAxis(3.0, 3.0, 0.0, 100.0, log);
    EXPECT_LT(axis.low, 3.0);
    EXPECT_GT(axis.high, 3.0);
  }
}

TEST(Range, CoversFiniteNumbersOnly) {
  Range range;
  range.cover(2.0);
  range.cover(-1.0);
  EXPECT_EQ(range.low, -1.0);
  EXPECT_EQ(range.high, 2.0);
  EXPECT_THROW(range.cover(std::nan("")), std::invalid_argument);
}

}  // namespace
}  // namespace palpate::program
