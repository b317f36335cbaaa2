// SPDX-License-Identifier: Apache-2.0
#include "core/base/kernels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <utility>
#include <vector>

#include "palpate/testing/instruction_sets.h"
#include "tests/core/base/random_numbers.h"

namespace palpate::testing {

TEST(Kernels, AllFiniteFindsWhatIsNoNumberAnywhere) {
  const InstructionSets sets;
  withEach(sets, [] {
    for (const std::size_t length : {0U, 1U, 7U, 8U, 64U, 67U}) {
      std::vector<float> x(length, -std::numeric_limits<float>::max());
      EXPECT_TRUE(allFinite(x)) << length;
      for (std::size_t i = 0; i < length; ++i)
        for (const float wrong :
             {std::numeric_limits<float>::quiet_NaN(), -std::numeric_limits<float>::infinity()}) {
          const float good = std::exchange(x[i], wrong);
          EXPECT_FALSE(allFinite(x)) << length << ' ' << i;
          x[i] = good;
        }
    }
  });
}

TEST(Kernels, MixIntoMovesOverByItsShare) {
  const InstructionSets sets;
  withEach(sets, [] {
    for (const float share : {0.0F, 0.25F, 1.0F}) {
      std::vector<float> y(37), from(37);
      for (std::size_t i = 0; i < y.size(); ++i) {
        y[i] = static_cast<float>(i);
        from[i] = -2.0F * static_cast<float>(i);
      }
      mixInto(from, share, y);
      for (std::size_t i = 0; i < y.size(); ++i)
        EXPECT_FLOAT_EQ(y[i], (1.0F - 3.0F * share) * static_cast<float>(i));
    }
  });
}

TEST(Kernels, PlacedRowsAreMixedAndMultipliedWhereTheyLie) {
  const InstructionSets sets;
  std::mt19937 random(11);
  std::uniform_real_distribution<double> number(-1.0, 1.0);
  constexpr std::size_t kStride = 80, kRows = 9;
  std::vector<double> A(kStride * kRows);
  for (double& a : A) a = number(random);
  const std::vector<std::int32_t> row{3, 0, 8, 5, 1, 7};
  withEach(sets, [&] {
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
          EXPECT_NEAR(dots[r], dot, 1e-13);
        }
        for (std::size_t i = 0; i < length; ++i)
          EXPECT_NEAR(mixed[i], sum[i], 1e-13) << count << ' ' << length;
      }
  });
}

TEST(Kernels, VectorsAreAddedToTheirNodesAlone) {
  constexpr std::size_t kNodes = 11;
  const InstructionSets sets;
  std::mt19937 random(23);
  const std::vector<std::int32_t> node{9, 2, 3, 10};
  for (const std::size_t count : {0U, 1U, 4U}) {
    const auto y = numbers<float>(3 * kTogether * count + 1, random),
               start = numbers<float>(kNodes * kNodeFloats, random);
    withEach(sets, [&] {
      std::vector<float> u = start;
      addVectors(y.data(), node.data(), count, -0.5F, u.data());
      for (std::size_t n = 0; n < kNodes; ++n)
        for (std::size_t k = 0; k < kNodeFloats; ++k) {
          const std::size_t at = n * kNodeFloats + k;
          const auto i = static_cast<std::size_t>(
              std::find(node.begin(), node.begin() + std::ptrdiff_t(count), int(n)) - node.begin());
          const bool added = i < count;
          if (added && k % 4 == 3) continue;  // those have no meaning
          const float more = added ? -0.5F * y[3 * (k / 4 * count + i) + k % 4] : 0.0F;
          EXPECT_NEAR(u[at], start[at] + more, 1e-6F) << count << ' ' << n << ' ' << k;
        }
    });
  }
}

TEST(Kernels, FloatsAreMixedTogetherWhereTheyLieAndAddedByAFactor) {
  const InstructionSets sets;
  std::mt19937 random(29);
  const std::vector<std::int32_t> row{3, 0, 8, 5, 1, 7};
  for (const std::size_t length : {1U, 12U, 16U, 32U, 67U}) {
    const auto A = numbers<float>(9 * length, random);
    for (const std::size_t count : {0U, 1U, 6U}) {
      const auto weight = numbers<float>(kTogether * count, random);
      withEach(sets, [&] {
        std::vector<float> y(kTogether * length, 7.0F);
        mixRowsTogether({A.data(), length, row.data(), count}, weight.data(), y.data());
        for (std::size_t c = 0; c < kTogether; ++c)
          for (std::size_t i = 0; i < length; ++i) {
            double sum = 0.0;
            for (std::size_t r = 0; r < count; ++r)
              sum += double(weight[kTogether * r + c]) *
                     double(A[length * static_cast<std::size_t>(row[r]) + i]);
            ASSERT_NEAR(double(y[c * length + i]), sum, 2e-6)
                << length << ' ' << count << ' ' << c << ' ' << i;
          }
        std::vector<float> more(length, 1.0F);
        addScaled(A.data(), -3.0F, more);
        for (std::size_t i = 0; i < length; ++i) ASSERT_NEAR(more[i], 1.0F - 3.0F * A[i], 1e-6F) << length;
      });
    }
  }
}

}  // namespace palpate::testing
