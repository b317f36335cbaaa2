// SPDX-License-Identifier: Apache-2.0
#include "core/base/kernels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <utility>
#include <vector>

#include "../instruction_sets.h"

namespace palpate::testing {

TEST(Kernels, AllFiniteFindsWhatIsNoNumberAnywhere) {
  const InstructionSets sets;
  for (const std::int64_t set : sets.list()) {
    hwy::SetSupportedTargetsForTest(set);
    chooseKernels();
    for (const std::size_t length : {0U, 1U, 7U, 8U, 64U, 67U}) {
      std::vector<float> x(length, -std::numeric_limits<float>::max());
      EXPECT_TRUE(allFinite(x)) << hwy::TargetName(set) << ' ' << length;
      for (std::size_t i = 0; i < length; ++i)
        for (const float wrong :
             {std::numeric_limits<float>::quiet_NaN(), -std::numeric_limits<float>::infinity()}) {
          const float good = std::exchange(x[i], wrong);
          EXPECT_FALSE(allFinite(x)) << hwy::TargetName(set) << ' ' << length << ' ' << i;
          x[i] = good;
        }
    }
  }
}

TEST(Kernels, MixIntoMovesOverByItsShare) {
  const InstructionSets sets;
  for (const std::int64_t set : sets.list()) {
    hwy::SetSupportedTargetsForTest(set);
    chooseKernels();
    for (const float share : {0.0F, 0.25F, 1.0F}) {
      std::vector<float> y(37), from(37);
      for (std::size_t i = 0; i < y.size(); ++i) {
        y[i] = static_cast<float>(i);
        from[i] = -2.0F * static_cast<float>(i);
      }
      mixInto(from, share, y);
      for (std::size_t i = 0; i < y.size(); ++i)
        EXPECT_FLOAT_EQ(y[i], (1.0F - 3.0F * share) * static_cast<float>(i)) << hwy::TargetName(set);
    }
  }
}

TEST(Kernels, AddRowsAddsEachRowByItsWeightAndScale) {
  const InstructionSets sets;
  std::mt19937 random(5);
  std::uniform_int_distribution<int> whole(-32768, 32767);
  std::uniform_real_distribution<float> number(-1.0F, 1.0F);
  for (const std::size_t count : {0U, 1U, 4U, 7U})
    for (const std::size_t length : {1U, 8U, 67U}) {
      std::vector<std::int16_t> A(count * length);
      std::vector<float> scale(count), weight(count), start(length);
      for (auto& a : A) a = static_cast<std::int16_t>(whole(random));
      for (std::size_t r = 0; r < count; ++r) {
        scale[r] = std::ldexp(1.0F, -static_cast<int>(r) - 15);
        weight[r] = number(random);
      }
      for (float& u : start) u = number(random);
      for (const std::int64_t set : sets.list()) {
        hwy::SetSupportedTargetsForTest(set);
        chooseKernels();
        std::vector<float> y = start;
        addRows({A.data(), scale.data(), count, length}, weight.data(), y.data());
        for (std::size_t i = 0; i < length; ++i) {
          double expected = double(start[i]);
          for (std::size_t r = 0; r < count; ++r)
            expected += double(weight[r]) * double(scale[r]) * A[r * length + i];
          ASSERT_NEAR(double(y[i]), expected, 1e-6) << hwy::TargetName(set) << ' ' << count << ' ' << i;
        }
      }
    }
}

TEST(Kernels, PlacedRowsAreMixedAndMultipliedWhereTheyLie) {
  const InstructionSets sets;
  std::mt19937 random(11);
  std::uniform_real_distribution<double> number(-1.0, 1.0);
  constexpr std::size_t kStride = 80, kRows = 9;
  std::vector<double> A(kStride * kRows);
  for (double& a : A) a = number(random);
  const std::vector<std::int32_t> row{3, 0, 8, 5, 1, 7};
  for (const std::int64_t set : sets.list()) {
    hwy::SetSupportedTargetsForTest(set);
    chooseKernels();
    for (const std::size_t count : {0U, 1U, 4U, 6U})
      for (const std::size_t length : {1U, 16U, 67U, 80U}) {
        std::vector<double> weight(count), mixed(length, 7.0), sum(length, 0.0);
        std::vector<double> y(length), dots(count);
        for (double& w : weight) w = number(random);
        for (double& x : y) x = number(random);
        mixRows({A.data(), kStride, row.data(), count}, weight.data(), length, mixed.data());
        dotRows({A.data(), kStride, row.data(), count}, y.data(), length, dots.data());
        for (std::size_t r = 0; r < count; ++r) {
          double dot = 0.0;
          for (std::size_t i = 0; i < length; ++i) {
            const double a = A[kStride * static_cast<std::size_t>(row[r]) + i];
            sum[i] += weight[r] * a;
            dot += a * y[i];
          }
          EXPECT_NEAR(dots[r], dot, 1e-13) << hwy::TargetName(set);
        }
        for (std::size_t i = 0; i < length; ++i)
          EXPECT_NEAR(mixed[i], sum[i], 1e-13) << hwy::TargetName(set) << ' ' << count << ' ' << length;
      }
  }
}

}  // namespace palpate::testing
