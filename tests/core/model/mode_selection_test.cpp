// SPDX-License-Identifier: Apache-2.0
#include "core/model/mode_selection.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

namespace palpate::testing {

TEST(ModeSelection, LeavesOutAsMuchAsItMay) {
  const ModeCounts counts{0, 0, 0, 64};
  ModeSelection selection(counts);
  std::vector<float> y(64, 1e-6F), peak(64, 1.0F), scale(64, 0.01F);
  const std::vector<std::int32_t> kinds{0, 0, 64};
  const PackedModes packed{{}, {}, scale, kinds, 0};
  for (std::size_t k = 0; k < 8; ++k) y[k] = 1e-3F;
  selection.choose(y, peak, packed, 0.0F);
  EXPECT_EQ(selection.quads8().size(), 16U);
  selection.choose(y, peak, packed, 1e-4F);
  EXPECT_EQ(selection.quads8().size(), 2U);  // 56 of 1e-6 m fit into 1e-4 m
  selection.choose(y, peak, packed, 5e-5F);
  EXPECT_EQ(selection.quads8().size(), 16U);  // but not into half of that
}

TEST(ModeSelection, WholeWeightsFitTheirSum) {
  const std::size_t n = 333;
  std::vector<float> peak(2 * n, 1.0F), scale(2 * n, 1.0F);
  const std::vector<std::int32_t> kinds{n, 0, n};
  const PackedModes packed{{}, {}, scale, kinds, 0};
  ModeSelection selection({0, n, 0, n});
  for (const float fall : {1.0F, 0.9F, 0.1F}) {
    std::vector<float> y(2 * n);
    for (std::size_t k = 0; k < y.size(); ++k)
      y[k] = std::pow(fall, static_cast<float>(k % n)) * (k % 2 == 0 ? 1.0F : -1.0F);
    selection.choose(y, peak, packed, 0.0F);
    long sum16 = 0, sum8 = 0;
    for (std::size_t p = 0; p < selection.pairs16().size(); ++p)
      sum16 += std::abs(selection.weights16()[p][0]) + std::abs(selection.weights16()[p][1]);
    for (std::size_t q = 0; q < selection.quads8().size(); ++q) {
      const QuadWeights& w = selection.weights8()[q];
      for (std::size_t two = 0; two < 2; ++two) {
        const int both = std::abs(w.byte[2 * two]) + std::abs(w.byte[2 * two + 1]);
        EXPECT_LE(both, 128);
        EXPECT_GE(w.pair[two], 0);
        sum8 += both * w.pair[two];
      }
    }
    EXPECT_LE(sum16, long{ModeSelection::kLargestSum});
    EXPECT_GT(sum16, 30000);
    EXPECT_LE(sum8, long{ModeSelection::kLargestByteSum});
    EXPECT_GT(sum8, 1000000);
  }
}

// Two bytes share a weight of sixteen bits; what their own of seven bits leave is added in a second pass.
TEST(ModeSelection, WeightsOfBytesAreExactToATwentiethOfAStep) {
  std::vector<float> peak(2, 1.0F), scale(2, 1.0F);
  const std::vector<std::int32_t> kinds{0, 0, 2};
  const PackedModes packed{{}, {}, scale, kinds, 0};
  ModeSelection selection({0, 0, 0, 2});
  std::size_t twice = 0;
  for (int i = -500; i <= 500; ++i) {
    const float small = static_cast<float>(i) / 500.0F;
    selection.choose(std::vector<float>{small, -1.0F}, peak, packed, 0.0F);
    std::array<float, 2> sum{};
    for (std::size_t q = 0; q < selection.quads8().size(); ++q) {
      const QuadWeights& w = selection.weights8()[q];
      for (std::size_t k = 0; k < 2; ++k)
        sum[k] += selection.unit8() * static_cast<float>(w.pair[0] * w.byte[k]);
    }
    twice += selection.quads8().size() - 1;
    EXPECT_NEAR(sum[0], small, 4e-4F);  // a step is 1 / 127
    EXPECT_NEAR(sum[1], -1.0F, 4e-4F);
  }
  EXPECT_GT(twice, 0U);
}

// The quads of a second pass lie anywhere among the others.
TEST(ModeSelection, SecondPassesBelongToTheirQuads) {
  constexpr std::size_t kModes = 203, kQuads = (kModes + 3) / 4;
  std::vector<float> peak(kModes, 1.0F), scale(kModes, 1.0F), y(kModes);
  const std::vector<std::int32_t> kinds{0, 0, kModes};
  const PackedModes packed{{}, {}, scale, kinds, 0};
  ModeSelection selection({0, 0, 0, kModes});
  std::mt19937 random(3);
  std::uniform_real_distribution<float> number(-1.0F, 1.0F);
  std::array<int, kQuads> twice{};
  for (int trial = 0; trial < 200; ++trial) {
    for (float& amplitude : y) amplitude = number(random);
    selection.choose(y, peak, packed, 0.0F);
    std::vector<float> sum(4 * kQuads, 0.0F);
    for (std::size_t i = 0; i < selection.quads8().size(); ++i) {
      const std::size_t quad = selection.quads8()[i];
      const QuadWeights& w = selection.weights8()[i];
      for (std::size_t k = 0; k < 4; ++k)
        sum[4 * quad + k] += selection.unit8() * static_cast<float>(w.pair[k / 2] * w.byte[k]);
      if (i >= kQuads) ++twice[quad];
    }
    for (std::size_t k = 0; k < kModes; ++k)
      ASSERT_NEAR(sum[k], y[k], 513.0F * selection.unit8()) << "mode " << k << " of trial " << trial;
  }
  EXPECT_GT(std::count_if(twice.begin(), twice.end(), [](int times) { return times > 0; }), 10);
}

}  // namespace palpate::testing
