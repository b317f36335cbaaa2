// SPDX-License-Identifier: Apache-2.0
#include "tools/examine/certify/quantile_bound.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace palpate::certify {
namespace {

/// P(B < k) of a binomial B of n and p, by products and sums alone.
double below(std::size_t k, std::size_t n, double p) {
  std::vector<double> probability(n + 1, 0.0);
  probability[0] = 1.0;
  for (std::size_t trial = 0; trial < n; ++trial)
    for (std::size_t x = n; x + 1 > 0; --x)
      probability[x] = (1.0 - p) * probability[x] + (x > 0 ? p * probability[x - 1] : 0.0);
  double sum = 0.0;
  for (std::size_t x = 0; x < k; ++x) sum += probability[x];
  return sum;
}

TEST(RankOfBound, NoneBelow59SamplesAndTheirLargestFromThen) {
  EXPECT_FALSE(rankOfBound(0));
  for (std::size_t n = 1; n < 59; ++n) EXPECT_FALSE(rankOfBound(n)) << n;
  EXPECT_NEAR(below(59, 59, 0.95), 1.0 - std::pow(0.95, 59), 1e-12);
  for (std::size_t n = 59; n < 93; ++n) EXPECT_EQ(rankOfBound(n), n);
}

TEST(RankOfBound, IsTheLeastWithThatConfidence) {
  for (std::size_t n = 59; n <= 400; ++n) {
    const std::size_t k = rankOfBound(n).value();
    EXPECT_GE(below(k, n, 0.95), 0.95) << n;
    EXPECT_LT(below(k - 1, n, 0.95), 0.95) << n;
  }
  EXPECT_EQ(rankOfBound(93), 92U);
  EXPECT_EQ(rankOfBound(124), 122U);
}

TEST(StatisticsOf, BoundHoldsAsOftenAsItSays) {
  constexpr int kTrials = 4000;
  std::mt19937_64 random(1);
  int held = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    std::vector<double> errors;
    for (int i = 0; i < 93; ++i) errors.push_back(static_cast<double>(random() >> 11U) * 0x1p-53);
    held += statisticsOf(errors).bound_95_95.value() >= 0.95;
  }
  const double expected = below(92, 93, 0.95), deviation = std::sqrt(expected * (1.0 - expected) / kTrials);
  EXPECT_NEAR(held / static_cast<double>(kTrials), expected, 4.0 * deviation);
}

TEST(StatisticsOf, TakesErrorsInAnyOrder) {
  const std::vector<double> errors{0.3, 0.1, 0.5, 0.2, 0.4};
  const ErrorStatistics s = statisticsOf(errors);
  EXPECT_EQ(s.p50, 0.3);
  EXPECT_EQ(s.p95, 0.5);
  EXPECT_EQ(s.max, 0.5);
  EXPECT_FALSE(s.bound_95_95);
}

}  // namespace
}  // namespace palpate::certify
