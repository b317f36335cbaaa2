// SPDX-License-Identifier: Apache-2.0
#include "core/base/kernels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <utility>
#include <vector>

#include "palpate/testing/instruction_sets.h"

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

namespace {

/// Whole numbers and scales of rows.
struct Whole {
  Whole(std::size_t rows, std::size_t length, std::mt19937& random) : A(rows * length), scale(rows) {
    std::uniform_int_distribution<int> whole(-32768, 32767);
    for (auto& a : A) a = static_cast<std::int16_t>(whole(random));
    for (std::size_t r = 0; r < rows; ++r) scale[r] = std::ldexp(1.0F, -static_cast<int>(r % 5) - 15);
  }
  std::vector<std::int16_t> A;
  std::vector<float> scale;
};

template <typename Number>
std::vector<Number> numbers(std::size_t count, std::mt19937& random) {
  std::uniform_real_distribution<Number> number(-1, 1);
  std::vector<Number> out(count);
  for (Number& x : out) x = number(random);
  return out;
}

/// Calls use() with each instruction set.
template <class Use>
void withEach(const InstructionSets& sets, const Use& use) {
  for (const std::int64_t set : sets.list()) {
    SCOPED_TRACE(hwy::TargetName(set));
    hwy::SetSupportedTargetsForTest(set);
    chooseKernels();
    use();
  }
}

}  // namespace

TEST(Kernels, SumsTakenTogetherAreThoseTakenOneByOne) {
  const InstructionSets sets;
  std::mt19937 random(17);
  for (const std::size_t count : {0U, 1U, 4U, 7U})
    for (const std::size_t length : {1U, 8U, 67U}) {
      const Whole rows(count, length, random);
      const auto weight = numbers<float>(kTogether * count, random),
                 start = numbers<float>(kTogether * length, random);
      withEach(sets, [&] {
        std::vector<float> y = start;
        addRowsTogether({rows.A.data(), rows.scale.data(), count, length}, weight.data(), y.data());
        for (std::size_t c = 0; c < kTogether; ++c) {
          std::vector<float> own(count), alone(start.begin() + std::ptrdiff_t(c * length),
                                               start.begin() + std::ptrdiff_t((c + 1) * length));
          for (std::size_t r = 0; r < count; ++r) own[r] = weight[kTogether * r + c];
          addRows({rows.A.data(), rows.scale.data(), count, length}, own.data(), alone.data());
          for (std::size_t i = 0; i < length; ++i)
            ASSERT_NEAR(y[c * length + i], alone[i], 2e-6F) << count << ' ' << i;
        }
      });
    }
}

TEST(Kernels, GroupsOfRowsAreAddedRowByRow) {
  const InstructionSets sets;
  std::mt19937 random(19);
  constexpr std::size_t kGroups = 9, kRows = 3, kLength = 67;
  const Whole rows(kGroups * kRows, kLength, random);
  const std::vector<std::int32_t> number{3, 0, 8, 5, 1, 7};
  for (const std::size_t count : {0U, 1U, 4U, 6U}) {
    const auto weight = numbers<double>(count, random);
    const auto start = numbers<float>(kRows * kLength, random);
    withEach(sets, [&] {
      std::vector<float> y = start;
      addGroups({rows.A.data(), rows.scale.data(), kRows, kLength, number.data(), count}, weight.data(),
                y.data());
      for (std::size_t r = 0; r < kRows; ++r)
        for (std::size_t i = 0; i < kLength; ++i) {
          double expected = double(start[r * kLength + i]);
          for (std::size_t g = 0; g < count; ++g) {
            const std::size_t row = kRows * static_cast<std::size_t>(number[g]) + r;
            expected += weight[g] * double(rows.scale[row]) * rows.A[row * kLength + i];
          }
          ASSERT_NEAR(double(y[r * kLength + i]), expected, 2e-6) << count << ' ' << r << ' ' << i;
        }
    });
  }
}

TEST(Kernels, VectorsAreAddedToTheirNodesAlone) {
  constexpr std::size_t kNodes = 11;
  const InstructionSets sets;
  std::mt19937 random(23);
  const std::vector<std::int32_t> node{9, 2, 3, 10};
  for (const std::size_t count : {0U, 1U, 4U}) {
    const Whole field(1, kThreeVectors * count + 4, random);
    const auto y = numbers<float>(3 * kTogether * count + 1, random),
               start = numbers<float>(kNodes * kNodeFloats, random);
    std::array<float, kNodeFloats> weight{};
    for (std::size_t k = 0; k < kThreeVectors; ++k) weight[k] = std::ldexp(float(k) + 1.0F, -20);
    withEach(sets, [&] {
      std::vector<float> whole = start, floats = start;
      addVectors(field.A.data(), node.data(), count, weight, whole.data());
      addVectors(y.data(), node.data(), count, -0.5F, floats.data());
      for (std::size_t n = 0; n < kNodes; ++n)
        for (std::size_t k = 0; k < kNodeFloats; ++k) {
          const std::size_t at = n * kNodeFloats + k;
          const auto i = static_cast<std::size_t>(
              std::find(node.begin(), node.begin() + std::ptrdiff_t(count), int(n)) - node.begin());
          const bool added = i < count, last = k % 4 == 3;  // those have no meaning
          const float more = added ? weight[k] * static_cast<float>(field.A[kThreeVectors * i + k]) : 0.0F;
          if (k < kThreeVectors) {
            EXPECT_NEAR(whole[at], start[at] + more, 1e-6F) << count << ' ' << n << ' ' << k;
          }
          if (added && last) continue;
          const float other = added ? -0.5F * y[3 * (k / 4 * count + i) + k % 4] : 0.0F;
          EXPECT_NEAR(floats[at], start[at] + other, 1e-6F) << count << ' ' << n << ' ' << k;
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
