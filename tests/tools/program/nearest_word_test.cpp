// SPDX-License-Identifier: Apache-2.0
#include "tools/program/nearest_word.h"

#include <gtest/gtest.h>

namespace palpate::program {
namespace {

const std::vector<std::string> kKnown{"--depth", "--domain", "--seconds", "--tool", "--at", "--plot"};

TEST(NearestWord, IsOneOrTwoEditsAway) {
  EXPECT_EQ(nearestWord("--dept", kKnown), "--depth");
  EXPECT_EQ(nearestWord("--dpeth", kKnown), "--depth") << "two neighbours swapped are one edit";
  EXPECT_EQ(nearestWord("--tools", kKnown), "--tool");
  EXPECT_EQ(nearestWord("--secnods", kKnown), "--seconds");
  EXPECT_EQ(nearestWord("--domane", kKnown), "--domain") << "two edits";
}

TEST(NearestWord, BeginsWithWhatWasWritten) {
  EXPECT_EQ(nearestWord("--sec", kKnown), "--seconds");
  EXPECT_EQ(nearestWord("-pl", kKnown), "--plot") << "dashes do not count";
}

TEST(NearestWord, IsNoneWhereNothingIsNear) {
  EXPECT_EQ(nearestWord("--colour", kKnown), std::nullopt);
  EXPECT_EQ(nearestWord("--bt", kKnown), "--at") << "one edit in two letters";
  EXPECT_EQ(nearestWord("--xy", kKnown), std::nullopt);
  EXPECT_EQ(nearestWord("--a", kKnown), std::nullopt) << "one letter says nothing";
  EXPECT_EQ(nearestWord("--depth", {}), std::nullopt);
}

}  // namespace
}  // namespace palpate::program
