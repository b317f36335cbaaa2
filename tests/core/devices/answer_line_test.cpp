// SPDX-License-Identifier: Apache-2.0
#include "core/devices/sim/answer_line.h"

#include <gtest/gtest.h>

namespace palpate::device {
namespace {

// Steps 0 to 9 send the poses 100 to 109.
AnswerLine<int> tenSteps() {
  AnswerLine<int> line;
  for (std::size_t i = 0; i < 10; ++i) line.sent(i, 100 + i);
  return line;
}

TEST(AnswerLine, GivesTheAnswerToThePoseOfTheStep) {
  AnswerLine<int> line = tenSteps();
  for (int i = 0; i < 10; ++i) line.add(100 + static_cast<std::uint64_t>(i), i);
  for (std::size_t i = 0; i < 10; ++i) {
    ASSERT_NE(line.at(i), nullptr);
    EXPECT_EQ(*line.at(i), static_cast<int>(i)) << "not the newest";
  }
}

TEST(AnswerLine, TheFirstAnswerToAStepCountsUnlessALaterOneIsInItsPlace) {
  AnswerLine<int> line = tenSteps();
  line.add(109, 1);
  line.add(109, 2);
  EXPECT_EQ(*line.at(9), 1);
  line.add(109, 3, true);
  EXPECT_EQ(*line.at(9), 3);
}

TEST(AnswerLine, WaitsForALateAnswerAndForNoOlderOne) {
  AnswerLine<int> line = tenSteps();
  EXPECT_FALSE(line.has(8));
  line.add(107, 7);
  EXPECT_FALSE(line.has(8)) << "the answer to the pose before is not it";
  EXPECT_TRUE(line.has(7));
  line.add(108, 8);
  EXPECT_TRUE(line.has(8));
  EXPECT_FALSE(line.has(9));
}

TEST(AnswerLine, OfASupersededPoseTheOneBeforeActsOnceALaterOneIsAnswered) {
  AnswerLine<int> line = tenSteps();
  line.add(106, 6);
  line.add(109, 9);
  EXPECT_TRUE(line.has(7)) << "7 and 8 are not answered any more";
  EXPECT_EQ(*line.at(7), 6);
  EXPECT_EQ(*line.at(8), 6) << "not 9, which was to act later";
  EXPECT_EQ(line.at(5), nullptr);
}

TEST(AnswerLine, AnAnswerThatWasOvertakenCountsWhereItIsStillWanted) {
  AnswerLine<int> line = tenSteps();
  line.add(109, 9);
  line.add(107, 7);
  EXPECT_EQ(*line.at(8), 7);
  EXPECT_EQ(*line.at(9), 9);
}

TEST(AnswerLine, TheFirstAnswerToAPoseThatWasSentAgainCounts) {
  AnswerLine<int> line;
  line.sent(0, 100);
  line.sent(1, 105);  // 101 to 104: the pose of step 0 again
  line.add(103, 3);
  line.add(104, 4);
  EXPECT_EQ(*line.at(0), 3);
  EXPECT_FALSE(line.has(1));
  line.add(99, 1);  // of a pose before the run
  EXPECT_FALSE(line.has(1));
}

TEST(AnswerLine, AStepThatSendsNoPoseHasTheAnswerBefore) {
  AnswerLine<int> line;
  line.sent(0, 100);
  line.sent(3, 101);
  line.add(100, 5);
  EXPECT_TRUE(line.has(2));
  EXPECT_FALSE(line.has(3));
  EXPECT_EQ(*line.at(2), 5);
}

TEST(AnswerLine, KeepsTheAnswersOfTheLongestDelay) {
  AnswerLine<int> line;
  for (std::size_t i = 0; i < 1000; ++i) {
    line.sent(i, 100 + i);
    line.add(100 + i, static_cast<int>(i));
    const std::size_t longest = Delays::kStall - 1;
    if (i < longest) continue;
    ASSERT_EQ(*line.at(i - longest), static_cast<int>(i - longest));
  }
}

}  // namespace
}  // namespace palpate::device
