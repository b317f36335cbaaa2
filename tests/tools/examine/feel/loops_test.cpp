// SPDX-License-Identifier: Apache-2.0
// The bounds of palpate-feel loops, on a small organ: the hand gets no energy from a closed way.
#include "tools/examine/feel/loops.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "uneven_organ.h"

namespace palpate::testing {

namespace {

feel::LoopOptions aDozen() {
  feel::LoopOptions options;
  options.loops = fewerUnderSanitizers(12);
  return options;
}

}  // namespace

TEST(Loops, AHeldAnchorGivesBackWhatItGot) {
  int counted = 0;
  const auto loops = feel::heldLoops(unevenOrgan(), aDozen());
  ASSERT_EQ(static_cast<int>(loops.size()), aDozen().loops);
  for (const feel::LoopResult& loop : loops) {
    EXPECT_GT(loop.stored, 1e-4) << "J: it was pressed";
    if (loop.releases > 0) continue;
    EXPECT_LT(std::abs(loop.share()), 1e-3);
    ++counted;
  }
  EXPECT_GE(2 * counted, aDozen().loops) << "most loops are without a release";
}

class SlidingLoops : public ::testing::TestWithParam<double> {};

TEST_P(SlidingLoops, BetweenSoftAndStiffPlacesGiveNoEnergy) {
  constexpr double kDepth = 0.002;  // m
  double least = INFINITY;
  const auto loops = feel::slidingLoops(unevenOrgan(), aDozen(), kDepth, GetParam());
  ASSERT_EQ(static_cast<int>(loops.size()), aDozen().loops);
  for (const feel::LoopResult& loop : loops) {
    EXPECT_GT(loop.stored, 1e-4) << "J: it was pressed";
    least = std::min(least, loop.share());
  }
  EXPECT_GT(least, -1e-2);
  RecordProperty("least_work_share", std::to_string(least));
}

INSTANTIATE_TEST_SUITE_P(Friction, SlidingLoops, ::testing::Values(0.0, 0.05, 0.3));

}  // namespace palpate::testing
