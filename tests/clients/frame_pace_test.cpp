// SPDX-License-Identifier: Apache-2.0
#include "palpate/client/frame_pace.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace palpate::client {
namespace {

constexpr std::int64_t kMs = 1'000'000;

TEST(FramePace, ASourceOfJustThisRatePassesWhole) {
  FramePace pace(60.0);
  std::mt19937 random(7);
  std::uniform_int_distribution<std::int64_t> jitter(-2 * kMs, 2 * kMs);
  int went = 0;
  for (std::int64_t i = 1; i <= 600; ++i) {
    const std::int64_t now = i * 16'666'667 + jitter(random);
    went += pace.admits(now) ? 1 : 0;
  }
  EXPECT_GE(went, 598);
}

TEST(FramePace, AFasterSourceIsThinnedToTheRate) {
  FramePace pace(60.0);
  int went = 0;
  for (std::int64_t now = kMs; now <= 10'000 * kMs; now += kMs) {
    went += pace.admits(now) ? 1 : 0;
  }
  EXPECT_NEAR(went, 600, 6);
}

TEST(FramePace, NoBunchAfterAPause) {
  FramePace pace(60.0);
  for (const std::int64_t start : {5000, 9000}) {
    std::vector<std::int64_t> went;
    for (std::int64_t ms = start; ms < start + 100; ++ms)
      if (pace.admits(ms * kMs)) went.push_back(ms - start);
    ASSERT_EQ(went.size(), 6U);
    EXPECT_EQ(went[0], 0);
    for (std::size_t i = 1; i < went.size(); ++i) EXPECT_NEAR(went[i] - went[i - 1], 16.7, 1.0);
  }
}

TEST(FramePace, NoRateIsNoFrame) {
  const FramePace pace(0.0);
  EXPECT_FALSE(pace.due(1'000'000 * kMs));
}

TEST(FramePace, AFasterRateHoldsAtOnce) {
  for (const double slow : {1.0, 0.001, 1e-300}) {
    FramePace pace(slow);
    const std::int64_t start = 1'000'000 * kMs;
    ASSERT_TRUE(pace.admits(start));
    EXPECT_FALSE(pace.due(start + 400 * kMs)) << slow;
    pace.setRate(0.0);
    pace.setRate(60.0);
    EXPECT_TRUE(pace.due(start + 20 * kMs)) << slow;
  }
}

TEST(FramePace, ASlowerRateHoldsAtOnce) {
  FramePace pace(60.0);
  pace.went(1'000'000 * kMs);
  pace.setRate(1.0);
  EXPECT_FALSE(pace.due(1'000'100 * kMs));
  EXPECT_TRUE(pace.due(1'001'000 * kMs));
}

TEST(FramePace, TheSlowestRateIsAFrameInTenSeconds) {
  FramePace pace(1e-300);
  pace.went(1'000'000 * kMs);
  EXPECT_FALSE(pace.due(1'009'000 * kMs));
  EXPECT_TRUE(pace.due(1'010'000 * kMs));
}

}  // namespace
}  // namespace palpate::client
