// SPDX-License-Identifier: Apache-2.0
// What a size limit leaves out of near fields.
#include "tools/solver/build/size_budget.h"

#include <gtest/gtest.h>

namespace palpate::solver {
namespace {

TEST(SizeBudget, KeepsTheLargestThatHaveRoom) {
  const NearSizes sizes{{0.5F, 0.1F, 0.02F}, {0.3F, 0.01F}};
  EXPECT_EQ(leastKept(sizes, 50.0, 11.0, 172.0), 0.0);
  const auto kept = [&](double room) {
    const double least = leastKept(sizes, 50.0, 11.0, room);
    double bytes = 0.0;
    for (const float size : sizes.positions) bytes += double{size} >= least ? 50.0 : 0.0;
    for (const float size : sizes.greens) bytes += double{size} >= least ? 11.0 : 0.0;
    return bytes;
  };
  EXPECT_EQ(kept(171.0), 161.0);
  EXPECT_EQ(kept(161.0), 161.0);
  EXPECT_EQ(kept(160.0), 111.0);
  EXPECT_EQ(kept(60.0), 50.0);
  EXPECT_EQ(kept(0.0), 0.0);
  EXPECT_EQ(kept(-1e6), 0.0);
}

/// Two sources of two rows; the last node of the first one is left out.
TEST(SizeBudget, LeavesOutNodesOfEveryRow) {
  std::vector<std::int64_t> offset{0, 3, 4};
  std::vector<std::int32_t> node{2, 5, 7, 1};
  std::vector<float> field;
  for (int number = 0; number < 24; ++number) field.push_back(static_cast<float>(number));
  leaveOutBelow(0.1, {0.2F, 1e6F, 0.05F, 1e6F}, 2, offset, node, field);
  EXPECT_EQ(offset, (std::vector<std::int64_t>{0, 2, 3}));
  EXPECT_EQ(node, (std::vector<std::int32_t>{2, 5, 1}));
  constexpr float kShare = 1.0F - 1.0F / 256.0F;  // of what is twice the limit
  const std::vector<float> expected{0.0F,          kShare,         2.0F * kShare,  3.0F,  4.0F,  5.0F,
                                    9.0F * kShare, 10.0F * kShare, 11.0F * kShare, 12.0F, 13.0F, 14.0F,
                                    18.0F,         19.0F,          20.0F,          21.0F, 22.0F, 23.0F};
  ASSERT_EQ(field.size(), expected.size());
  for (std::size_t i = 0; i < field.size(); ++i) EXPECT_NEAR(field[i], expected[i], 1e-5) << i;
}

/// What is left out and what remains differ by no step, and nothing is changed by more than the part that is left out.
TEST(SizeBudget, HasNoStepWhereNearFieldsEnd) {
  constexpr double kLeast = 0.02;
  double before = 0.0;
  for (int i = 0; i <= 400; ++i) {
    const double size = 1e-4 * i;
    std::vector<std::int64_t> offset{0, 1};
    std::vector<std::int32_t> node{0};
    std::vector<float> field{static_cast<float>(size), 0.0F, 0.0F};
    leaveOutBelow(kLeast, {static_cast<float>(size)}, 1, offset, node, field);
    const double now = field.empty() ? 0.0 : double{field[0]};
    EXPECT_LT(std::abs(now - before), 8.1e-4) << size;
    EXPECT_LE(size - now, 1.0001 * kLeast) << size;
    before = now;
  }
  EXPECT_GT(before, 0.025);
}

}  // namespace
}  // namespace palpate::solver
