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
#include "core/model/byte_weights.h"

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

// Of any two amplitudes: what is left is what the weights do not say, and less than a hundredth of the larger
// amplitude or 64 units.
TEST(Kernels, WeighPairsSaysWhatIsLeft) {
  constexpr std::size_t kPairs = 100, kRoom = pairBlocks(kPairs);
  std::mt19937 random(5);
  std::uniform_real_distribution<float> number(-1.0F, 1.0F);
  std::vector<float> a(kRoom, 0.0F), b(kRoom, 0.0F);
  for (std::size_t i = 2; i < kPairs; ++i) {
    a[i] = number(random);
    b[i] = i % 5 == 0 ? 0.0F : number(random);
  }
  a[1] = b[1] = -1.0F;
  const float unit = 1.0F / (kLeastByte * 32767.0F);
  const InstructionSets sets;
  for (const std::int64_t set : sets.list()) {
    hwy::SetSupportedTargetsForTest(set);
    chooseKernels();
    std::vector<float> even = a, odd = b, left(kRoom);
    std::vector<std::int16_t> bytes(kRoom), weight(kRoom);
    const std::int32_t products =
        weighPairs({even.data(), odd.data(), left.data(), bytes.data(), weight.data()}, kPairs, unit);
    std::int32_t sum = 0;
    for (std::size_t i = 0; i < kPairs; ++i) {
      const auto both = static_cast<std::uint16_t>(bytes[i]);
      const int first = static_cast<std::int8_t>(both & 255U), second = static_cast<std::int8_t>(both >> 8U);
      EXPECT_LE(std::abs(first) + std::abs(second), 128);
      EXPECT_GE(weight[i], 0);
      sum += weight[i] * (first + second);
      EXPECT_NEAR(even[i], a[i] - unit * static_cast<float>(weight[i] * first), 1e-6F);
      EXPECT_NEAR(odd[i], b[i] - unit * static_cast<float>(weight[i] * second), 1e-6F);
      EXPECT_FLOAT_EQ(left[i], std::max(std::abs(even[i]), std::abs(odd[i])));
      EXPECT_LT(left[i], 1e-2F * std::max(std::abs(a[i]), std::abs(b[i])) + 64.0F * unit)
          << hwy::TargetName(set) << ' ' << a[i] << ' ' << b[i];
    }
    EXPECT_EQ(products, sum) << hwy::TargetName(set);
  }
}

}  // namespace palpate::testing
