// SPDX-License-Identifier: Apache-2.0
#include "palpate/client/gap_counter.h"

#include <gtest/gtest.h>

namespace palpate::client {
namespace {

GapCounter after(std::initializer_list<std::uint64_t> seqs) {
  GapCounter counter;
  for (const auto seq : seqs) counter.add(7, seq);
  return counter;
}

TEST(GapCounter, NothingIsLostWithoutAGap) {
  EXPECT_EQ(after({7, 8, 9, 10}).lost(), 0U);
}
TEST(GapCounter, EachMissingNumberIsOneLost) {
  EXPECT_EQ(after({7, 9, 10, 14}).lost(), 4U);
}
TEST(GapCounter, AServerThatStartsAnewLosesNothing) {
  const GapCounter counter = after({1000, 1001, 1, 2, 4});
  EXPECT_EQ(counter.lost(), 1U);
  EXPECT_EQ(counter.restarts(), 1U);
  EXPECT_EQ(counter.received(), 5U);
}
TEST(GapCounter, AnotherSessionIsARestartHoweverHighItCounts) {
  GapCounter counter;
  counter.add(1, 5);
  counter.add(2, 122'917'846);
  counter.add(2, 122'917'848);
  EXPECT_EQ(counter.lost(), 1U);
  EXPECT_EQ(counter.restarts(), 1U);
}

}  // namespace
}  // namespace palpate::client
