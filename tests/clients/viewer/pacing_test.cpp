// SPDX-License-Identifier: Apache-2.0
#include "pacing.h"

#include <gtest/gtest.h>

#include <random>

namespace palpate::viewer {
namespace {

constexpr std::int64_t kMs = 1'000'000;

TEST(Pacing, ABucketLetsItsRateThroughAndAFloodNot) {
  TokenBucket bucket(400.0, 400.0);
  std::int64_t now = kMs;
  for (int i = 0; i < 4000; ++i, now += 4 * kMs)
    ASSERT_TRUE(bucket.take(now)) << "250 a second, message " << i;
  int through = 0;
  for (int i = 0; i < 10'000; ++i, now += kMs / 10)
    through += bucket.take(now) ? 1 : 0;  // 10,000 in a second
  EXPECT_NEAR(through, 800, 5) << "what was saved, and a second's worth";
}

TEST(Pacing, ASourceOfJustThisRatePassesWhole) {
  FramePace pace(60.0);
  std::mt19937 random(7);
  std::uniform_int_distribution<std::int64_t> jitter(-2 * kMs, 2 * kMs);
  int went = 0;
  for (std::int64_t i = 1; i <= 600; ++i) {
    const std::int64_t now = i * 16'666'667 + jitter(random);
    if (!pace.due(now)) continue;
    pace.went(now);
    ++went;
  }
  EXPECT_GE(went, 598);
}

TEST(Pacing, AFasterSourceIsThinnedToTheRate) {
  FramePace pace(60.0);
  int went = 0;
  for (std::int64_t now = kMs; now <= 10'000 * kMs; now += kMs) {
    if (!pace.due(now)) continue;
    pace.went(now);
    ++went;
  }
  EXPECT_NEAR(went, 600, 6);
}

TEST(Pacing, NoRateIsNoFrame) {
  const FramePace pace(0.0);
  EXPECT_FALSE(pace.due(1'000'000 * kMs));
}

TEST(Pacing, AFasterRateHoldsAtOnce) {
  for (const double slow : {1.0, 0.001, 1e-300}) {
    FramePace pace(slow);
    const std::int64_t start = 1'000'000 * kMs;
    for (int i = 0; i < 2; ++i) {  // after a pause the second may go half a period early, and counts as later
      ASSERT_TRUE(pace.due(start));
      pace.went(start);
    }
    EXPECT_FALSE(pace.due(start + 400 * kMs)) << slow;
    pace.setRate(0.0);
    pace.setRate(60.0);
    EXPECT_TRUE(pace.due(start + 20 * kMs)) << slow;
  }
}

TEST(Pacing, ASlowerRateHoldsAtOnce) {
  FramePace pace(60.0);
  pace.went(1'000'000 * kMs);
  pace.setRate(1.0);
  EXPECT_FALSE(pace.due(1'000'100 * kMs));
  EXPECT_TRUE(pace.due(1'001'000 * kMs));
}

TEST(Pacing, TheSlowestRateIsAFrameInTenSeconds) {
  FramePace pace(1e-300);
  for (int i = 0; i < 2; ++i) pace.went(1'000'000 * kMs);
  EXPECT_FALSE(pace.due(1'009'000 * kMs));
  EXPECT_TRUE(pace.due(1'010'000 * kMs));
}

}  // namespace
}  // namespace palpate::viewer
