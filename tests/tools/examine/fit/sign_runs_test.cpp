// SPDX-License-Identifier: Apache-2.0
#include "tools/examine/fit/sign_runs.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace palpate::fit {
namespace {

TEST(SignRuns, FewRunsAreImprobableAndManyAreNot) {
  std::vector<double> halves(40, 1.0), turns(40, 1.0);
  for (std::size_t i = 0; i < 40; ++i) {
    if (i >= 20) halves[i] = -1.0;
    if (i % 2 == 1) turns[i] = -1.0;
  }
  EXPECT_LT(probabilityOfRuns(halves), 1e-6);
  EXPECT_GT(probabilityOfRuns(turns), 0.999);
  // 20 of each sign: mean 21, variance 2 400 (2 400 - 40) / (40^2 39) = 9.744; here are 14 runs.
  std::vector<double> some;
  for (const int length : {3, 3, 3, 3, 3, 3, 2})
    for (const double sign : {1.0, -1.0}) some.insert(some.end(), static_cast<std::size_t>(length), sign);
  ASSERT_EQ(some.size(), 40U);
  EXPECT_NEAR(*probabilityOfRuns(some), 0.5 * std::erfc((21.0 - 14.5) / std::sqrt(2.0 * 9.7436)), 1e-4);
}

TEST(SignRuns, NoiseFailsAsOftenAsItSays) {
  std::mt19937_64 random(5);
  std::normal_distribution<double> noise;
  int rare = 0;
  for (int run = 0; run < 2000; ++run) {
    std::vector<double> residuals(60);
    for (double& r : residuals) r = noise(random);
    if (*probabilityOfRuns(residuals) < 0.05) ++rare;
  }
  EXPECT_GT(rare, 50);
  EXPECT_LT(rare, 150);
}

TEST(SignRuns, SaysNothingOfFewPoints) {
  std::vector<double> residuals(9, 1.0);
  residuals.insert(residuals.end(), 30, -1.0);
  EXPECT_FALSE(probabilityOfRuns(residuals));
  residuals.insert(residuals.end(), {0.0, 0.0, 0.0});
  EXPECT_FALSE(probabilityOfRuns(residuals));
}

}  // namespace
}  // namespace palpate::fit
