// SPDX-License-Identifier: Apache-2.0
#include "palpate/client/histogram.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace palpate::client {
namespace {

TEST(Histogram, PercentilesAreWithinOneBucketOfTheSortedValues) {
  std::mt19937_64 random(7);
  std::lognormal_distribution<double> times(std::log(80e3), 1.0);
  std::vector<std::int64_t> values(20001);
  Histogram histogram;
  for (auto& value : values) {
    value = static_cast<std::int64_t>(times(random));
    histogram.add(value);
  }
  std::sort(values.begin(), values.end());
  for (const double q : {0.0, 0.1, 0.5, 0.9, 0.99, 0.999, 1.0}) {
    const auto rank =
        std::max<std::size_t>(1, static_cast<std::size_t>(std::ceil(q * static_cast<double>(values.size()))));
    const auto exact = static_cast<double>(values[rank - 1]);
    const auto found = static_cast<double>(histogram.percentile(q));
    EXPECT_GE(found, exact) << q;
    EXPECT_LE(found, exact * (1.0 + 1.0 / 64.0)) << q;
  }
  EXPECT_EQ(histogram.max(), values.back());
  EXPECT_EQ(histogram.percentile(1.0), values.back());
  EXPECT_EQ(histogram.count(), values.size());
}

TEST(Histogram, SmallTimesAreExact) {
  Histogram histogram;
  for (int ns = 1; ns <= 60; ++ns) histogram.add(ns);
  EXPECT_EQ(histogram.percentile(0.5), 30);
  EXPECT_EQ(histogram.percentile(0.9), 54);
}

TEST(Histogram, NeverSaysMoreThanTheLargestValue) {
  Histogram histogram;
  histogram.add(1'000'001);
  EXPECT_EQ(histogram.percentile(0.5), 1'000'001);
  EXPECT_DOUBLE_EQ(histogram.summary().p999, 1000.001);
}

TEST(Histogram, EmptyIsZero) {
  const Histogram histogram;
  EXPECT_EQ(histogram.percentile(0.99), 0);
  EXPECT_EQ(histogram.summary().count, 0U);
  EXPECT_TRUE(histogram.bars(10).empty());
}

TEST(Histogram, ExtremesAreCountedNotLost) {
  Histogram histogram;
  histogram.add(-5);
  histogram.add(std::int64_t{1} << 62);
  EXPECT_EQ(histogram.count(), 2U);
  EXPECT_EQ(histogram.percentile(0.5), 0);
  EXPECT_EQ(histogram.percentile(1.0), std::int64_t{1} << 62);
}

TEST(Histogram, BarsHoldEveryValueAndTouch) {
  Histogram histogram;
  for (const std::int64_t ns : {900, 1000, 1001, 50'000, 50'000, 9'000'000}) histogram.add(ns);
  const auto bars = histogram.bars(10);
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
