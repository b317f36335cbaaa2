// SPDX-License-Identifier: Apache-2.0
#include "palpate/rt/cycle_stats.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <random>
#include <vector>

namespace palpate::rt {
namespace {

TEST(CycleStats, EmptyHasNoQuantiles) {
  const CycleStats stats;
  EXPECT_EQ(stats.count(), 0U);
  EXPECT_EQ(stats.quantile(0.5), 0);
  EXPECT_EQ(stats.max(), 0);
}

TEST(CycleStats, ShortDurationsAreExact) {
  CycleStats stats;
  for (int ns = 1; ns <= 100; ++ns) stats.add(ns);
  EXPECT_EQ(stats.quantile(0.0), 1);
  EXPECT_EQ(stats.quantile(0.5), 50);
  EXPECT_EQ(stats.quantile(0.99), 99);
  EXPECT_EQ(stats.quantile(1.0), 100);
}

TEST(CycleStats, ThoseOfAnotherAreAdded) {
  CycleStats one, other;
  for (int ns = 1; ns <= 50; ++ns) one.add(ns);
  for (int ns = 51; ns <= 100; ++ns) other.add(ns);
  one.add(other);
  one.add(CycleStats{});
  EXPECT_EQ(one.count(), 100U);
  EXPECT_EQ(one.quantile(0.75), 75);
  EXPECT_EQ(one.max(), 100);
}

TEST(CycleStats, QuantilesAgreeWithSortingWithinOneBucket) {
  std::mt19937_64 random(7);
  std::lognormal_distribution<double> durations(10.0, 2.0);
  CycleStats stats;
  std::vector<std::int64_t> all;
  for (int i = 0; i < 20'000; ++i) {
    all.push_back(static_cast<std::int64_t>(durations(random)));
    stats.add(all.back());
  }
  std::sort(all.begin(), all.end());
  for (const double fraction : {0.01, 0.5, 0.9, 0.99, 0.999}) {
    const auto rank = static_cast<std::size_t>(std::ceil(fraction * static_cast<double>(all.size()))) - 1;
    const auto exact = static_cast<double>(all[rank]);
    EXPECT_GE(static_cast<double>(stats.quantile(fraction)), exact) << fraction;
    EXPECT_LE(static_cast<double>(stats.quantile(fraction)), exact * (1.0 + 1.0 / 64) + 1) << fraction;
  }
  EXPECT_EQ(stats.max(), all.back());
  EXPECT_EQ(stats.quantile(1.0), all.back());
}

TEST(CycleStats, BucketsAscendAndHoldEveryDuration) {
  CycleStats stats;
  for (const std::int64_t ns : {1, 63, 64, 127, 128, 129, 1'000'000}) stats.add(ns);
  std::uint64_t total = 0;
  std::int64_t below = -1;
  for (std::size_t i = 0; i < CycleStats::kBuckets; ++i) {
    const CycleStats::Bucket bucket = stats.bucket(i);
    EXPECT_GT(bucket.upper_ns, below) << i;
    below = bucket.upper_ns;
    total += bucket.count;
  }
  EXPECT_EQ(total, stats.count());
  EXPECT_EQ(stats.bucket(64).count, 1U);   // 64 has a bucket of its own
  EXPECT_EQ(stats.bucket(128).count, 2U);  // 128 and 129 share one
}

TEST(CycleStats, ValuesOutsideTheRangeAreCountedInTheEndBuckets) {
  CycleStats stats;
  stats.add(-5);
  EXPECT_EQ(stats.quantile(1.0), 0);
  stats.add(INT64_MAX);
  EXPECT_EQ(stats.count(), 2U);
  EXPECT_EQ(stats.max(), INT64_MAX);
  EXPECT_EQ(stats.quantile(1.0), (std::int64_t{1} << 40) - 1);
  stats.clear();
  EXPECT_EQ(stats.count(), 0U);
}

}  // namespace
}  // namespace palpate::rt
