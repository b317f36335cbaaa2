// SPDX-License-Identifier: Apache-2.0
#include "core/base/whole_kernels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <random>
#include <span>
#include <vector>

#include "palpate/testing/instruction_sets.h"
#include "tests/core/base/random_numbers.h"

namespace palpate::testing {

namespace {

/// Whole numbers of one byte or of two, and scales of rows.
struct Whole {
  Whole(std::size_t rows, std::size_t length, std::size_t size, std::mt19937& random)
      : bytes(size == 1 ? rows * length : 0), pairs(size == 2 ? rows * length : 0), scale(rows) {
    std::uniform_int_distribution<int> byte(-128, 127), pair(-32768, 32767);
    for (auto& a : bytes) a = static_cast<std::int8_t>(byte(random));
    for (auto& a : pairs) a = static_cast<std::int16_t>(pair(random));
    A = size == 1 ? WholeNumbers(std::span<const std::int8_t>(bytes))
                  : WholeNumbers(std::span<const std::int16_t>(pairs));
    for (std::size_t r = 0; r < rows; ++r)
      scale[r] = std::ldexp(1.0F, -static_cast<int>(r % 5) - (size == 1 ? 7 : 15));
  }
  std::vector<std::int8_t> bytes;
  std::vector<std::int16_t> pairs;
  WholeNumbers A;
  std::vector<float> scale;
};

constexpr std::array<std::size_t, 2> kBytesOfANumber{1, 2};

}  // namespace

TEST(WholeKernels, AddRowsAddsEachRowByItsWeightAndScale) {
  const InstructionSets sets;
  std::mt19937 random(5);
  for (const std::size_t count : {0U, 1U, 4U, 7U})
    for (const std::size_t length : {1U, 8U, 67U})
      for (const std::size_t size : kBytesOfANumber) {
        const Whole rows(count, length, size, random);
        const auto weight = numbers<float>(count, random), start = numbers<float>(length, random);
        withEach(sets, [&] {
          std::vector<float> y = start;
          addRows({rows.A, rows.scale.data(), count, length}, weight.data(), y.data());
          for (std::size_t i = 0; i < length; ++i) {
            double expected = double(start[i]);
            for (std::size_t r = 0; r < count; ++r)
              expected += double(weight[r]) * double(rows.scale[r]) * rows.A[r * length + i];
            ASSERT_NEAR(double(y[i]), expected, 2e-6) << count << ' ' << i;
          }
        });
      }
}

TEST(WholeKernels, SumsTakenTogetherAreThoseTakenOneByOne) {
  const InstructionSets sets;
  std::mt19937 random(17);
  for (const std::size_t count : {0U, 1U, 4U, 7U})
    for (const std::size_t length : {1U, 8U, 67U})
      for (const std::size_t size : kBytesOfANumber) {
        const Whole rows(count, length, size, random);
        const auto weight = numbers<float>(kTogether * count, random),
                   start = numbers<float>(kTogether * length, random);
        withEach(sets, [&] {
          std::vector<float> y = start;
          addRowsTogether({rows.A, rows.scale.data(), count, length}, weight.data(), y.data());
          for (std::size_t c = 0; c < kTogether; ++c) {
            std::vector<float> own(count), alone(start.begin() + std::ptrdiff_t(c * length),
                                                 start.begin() + std::ptrdiff_t((c + 1) * length));
            for (std::size_t r = 0; r < count; ++r) own[r] = weight[kTogether * r + c];
            addRows({rows.A, rows.scale.data(), count, length}, own.data(), alone.data());
            for (std::size_t i = 0; i < length; ++i)
              ASSERT_NEAR(y[c * length + i], alone[i], 2e-6F) << count << ' ' << i;
          }
        });
      }
}

TEST(WholeKernels, GroupsOfRowsAreAddedRowByRow) {
  const InstructionSets sets;
  std::mt19937 random(19);
  constexpr std::size_t kGroups = 9, kRows = 3, kLength = 67;
  const std::vector<std::int32_t> number{3, 0, 8, 5, 1, 7};
  for (const std::size_t size : kBytesOfANumber)
    for (const std::size_t count : {0U, 1U, 4U, 6U}) {
      const Whole rows(kGroups * kRows, kLength, size, random);
      const auto weight = numbers<double>(count, random);
      const auto start = numbers<float>(kRows * kLength, random);
      withEach(sets, [&] {
        std::vector<float> y = start;
        addGroups({rows.A, rows.scale.data(), kRows, kLength, number.data(), count}, weight.data(), y.data());
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

TEST(WholeKernels, MatricesAreAddedToTheirNodesAlone) {
  constexpr std::size_t kNodes = 11;
  const InstructionSets sets;
  std::mt19937 random(23);
  const std::vector<std::int32_t> node{9, 2, 3, 10};
  for (const std::size_t size : kBytesOfANumber)
    for (const std::size_t count : {0U, 1U, 4U}) {
      const Whole field(1, kMatrixNumbers * count, size, random);
      const auto start = numbers<float>(kNodes * kNodeFloats, random);
      std::array<float, kNodeFloats> weight{};
      for (std::size_t k = 0; k < kMatrixNumbers; ++k) weight[k] = std::ldexp(float(k) + 1.0F, -20);
      withEach(sets, [&] {
        std::vector<float> u = start;
        addMatrices(field.A, node.data(), count, weight, u.data());
        for (std::size_t n = 0; n < kNodes; ++n)
          for (std::size_t k = 0; k < kNodeFloats; ++k) {
            const std::size_t at = n * kNodeFloats + k;
            const auto i = static_cast<std::size_t>(
                std::find(node.begin(), node.begin() + std::ptrdiff_t(count), int(n)) - node.begin());
            const float more = i < count && k < kMatrixNumbers
                                   ? weight[k] * static_cast<float>(field.A[kMatrixNumbers * i + k])
                                   : 0.0F;
            EXPECT_NEAR(u[at], start[at] + more, 1e-6F) << count << ' ' << n << ' ' << k;
          }
      });
    }
}

TEST(WholeKernels, RowsAreMixedTogetherWhereTheyLie) {
  const InstructionSets sets;
  std::mt19937 random(31);
  const std::vector<std::int32_t> row{3, 0, 8, 5, 1, 7};
  for (const std::size_t size : kBytesOfANumber)
    for (const std::size_t length : {1U, 12U, 32U, 67U}) {
      const Whole rows(9, length, size, random);
      const auto weight = numbers<float>(kTogether * row.size(), random);
      const double step = std::ldexp(1.0, size == 1 ? -7 : -15);  // so that all sums are of numbers up to 1
      withEach(sets, [&] {
        std::vector<float> mixed(kTogether * length, 7.0F);
        mixRowsTogether({rows.A, length, row.data(), row.size()}, weight.data(), mixed.data());
        for (std::size_t c = 0; c < kTogether; ++c)
          for (std::size_t i = 0; i < length; ++i) {
            double sum = 0.0;
            for (std::size_t r = 0; r < row.size(); ++r)
              sum +=
                  double(weight[kTogether * r + c]) * rows.A[length * static_cast<std::size_t>(row[r]) + i];
            ASSERT_NEAR(step * double(mixed[c * length + i]), step * sum, 2e-6)
                << length << ' ' << c << ' ' << i;
          }
      });
    }
}

/// With few rows or none, and lengths with and without room for zeros behind them.
TEST(WholeKernels, DotRowsMultipliesEachRow) {
  const InstructionSets sets;
  std::mt19937 random(37);
  for (const std::size_t size : kBytesOfANumber)
    for (const std::size_t count : {0U, 1U, 4U, 5U, 9U})
      for (const std::size_t length : {0U, 1U, 67U, 1000U, 1024U, 1025U}) {
        const Whole rows(count, length, size, random);
        const auto y = numbers<float>(length, random);
        const double step = std::ldexp(1.0, size == 1 ? -7 : -15);
        withEach(sets, [&] {
          std::vector<float> dots(count, 7.0F);
          dotRows(rows.A, y.data(), count, length, dots.data());
          for (std::size_t r = 0; r < count; ++r) {
            double dot = 0.0;
            for (std::size_t i = 0; i < length; ++i) dot += double(y[i]) * rows.A[length * r + i];
            ASSERT_NEAR(step * double(dots[r]), step * dot, 2e-5) << count << ' ' << length << ' ' << r;
          }
        });
      }
}

}  // namespace palpate::testing
