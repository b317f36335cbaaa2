// SPDX-License-Identifier: Apache-2.0
#include "palpate/client/time_summary.h"

#include <gtest/gtest.h>

#include <cmath>

namespace palpate::client {
namespace {

TEST(TimeSummary, IsInMicrosecondsAndNeverAboveTheLargest) {
  rt::CycleStats times;
  times.add(1'000'001);
  const TimeSummary summary = summaryOf(times);
  EXPECT_DOUBLE_EQ(summary.p50, 1000.001);
  EXPECT_DOUBLE_EQ(summary.p999, 1000.001);
  EXPECT_DOUBLE_EQ(summary.max, 1000.001);
  EXPECT_EQ(summary.count, 1U);
}

TEST(TimeSummary, OfNothingIsZero) {
  EXPECT_EQ(summaryOf({}).count, 0U);
  EXPECT_EQ(summaryOf({}).p999, 0.0);
  EXPECT_TRUE(barsOf({}, 10).empty());
}

TEST(HistogramBars, HoldEveryValueAndTouch) {
  rt::CycleStats times;
  for (const std::int64_t ns : {900, 1000, 1001, 50'000, 50'000, 9'000'000}) times.add(ns);
  const auto bars = barsOf(times, 10);
  ASSERT_FALSE(bars.empty());
  std::uint64_t total = 0;
  for (std::size_t i = 0; i < bars.size(); ++i) {
    total += bars[i].count;
    EXPECT_NEAR(bars[i].to_ns / bars[i].from_ns, std::pow(10.0, 0.1), 1e-9);
    EXPECT_NEAR(bars[i].from_ns, i > 0 ? bars[i - 1].to_ns : bars[i].from_ns, 1e-9 * bars[i].from_ns);
  }
  EXPECT_EQ(total, 6U);
  EXPECT_LE(bars.front().from_ns, 900.0);
  EXPECT_GE(bars.back().to_ns, 9'000'000.0);
}

}  // namespace
}  // namespace palpate::client
