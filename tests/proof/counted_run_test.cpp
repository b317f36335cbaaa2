// SPDX-License-Identifier: Apache-2.0
// The real server, from inside: what its tick thread calls while two tools press and slide (docs/design.md, Threads).
#include "counted_run.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <iostream>
#include <string>

namespace palpate::proof {
namespace {

// One run for all facts about it; PALPATE_COUNTED_JSON names a file that it is written to.
class CountedServer : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    run_ = countTicks(optionsFromEnvironment());
    std::cout << table(run_);
    if (const char* const file = std::getenv("PALPATE_COUNTED_JSON")) std::ofstream(file) << json(run_);
  }
  void SetUp() override { ASSERT_GT(run_.sleeps, 0) << run_.log; }

  static inline CountedRun run_;
};

TEST_F(CountedServer, ItsToolsAreInContactAndSlideWhileItIsCounted) {
  ASSERT_EQ(run_.tools.size(), 2U);
  for (const Answers& tool : run_.tools) {
    EXPECT_GT(tool.in_contact, tool.all / 2) << run_.log;
    EXPECT_GT(tool.sliding, tool.all / 10);
    EXPECT_GT(tool.free, 0U) << "contact never began again";
  }
  EXPECT_GT(run_.fields, run_.sleeps / 2) << "and somebody sees the surface";
}

TEST_F(CountedServer, ItsTickAllocatesLocksAndWaitsForNothing) {
  EXPECT_EQ(run_.of(Kind::kAllocation), 0);
  EXPECT_EQ(run_.of(Kind::kFree), 0);
  EXPECT_EQ(run_.of(Kind::kLock), 0);
  EXPECT_EQ(run_.of(Kind::kWait), 0);
  EXPECT_EQ(run_.of(Kind::kSystemCall), 0);
}

TEST_F(CountedServer, ItsTickSleepsOnceAndWakesOneThread) {
  EXPECT_LE(run_.usage.voluntary, run_.sleeps) << "it waited for something else";
  EXPECT_GE(run_.usage.voluntary, run_.sleeps / 2) << "it does not sleep: are these its counts?";
  EXPECT_EQ(run_.posts[0].count, run_.sleeps) << "force-out is woken in every tick";
  EXPECT_EQ(run_.posts[1].count + run_.posts[2].count + run_.posts[3].count + run_.other_posts, 0)
      << "nobody else is";
}

TEST_F(CountedServer, ItsTickMeetsNoPageFault) {
  if (!run_.memory_locked) GTEST_SKIP() << "memory could not be locked here: page faults are not judged";
  EXPECT_EQ(run_.faults(), 0);
}

// The same server while it goes over to another organ: the model is checked and mapped beside, forces end, begin again.
TEST(CountedSwap, ItsTickDoesNotNoticeAnotherOrgan) {
  const CountedRun run = countTicks({.seconds = 4.0, .model = {}, .mistake = {}, .swaps = true});
  std::cout << table(run);
  ASSERT_TRUE(run.swapped) << run.log;
  for (const Kind kind : {Kind::kAllocation, Kind::kFree, Kind::kLock, Kind::kWait, Kind::kSystemCall})
    EXPECT_EQ(run.of(kind), 0) << static_cast<int>(kind);
  EXPECT_LE(run.usage.voluntary, run.sleeps);
  EXPECT_EQ(run.posts[0].count, run.sleeps);
  EXPECT_EQ(run.other_posts + run.posts[1].count, 0) << "it wakes nobody but force-out";
  for (const Answers& tool : run.tools) EXPECT_GT(tool.in_contact, tool.all / 3) << "contact comes back";
  if (run.memory_locked) {
    EXPECT_EQ(run.faults(), 0);
  }
}

// Twins of the server whose tick makes one mistake now and then: each must be found, and by the count that it is about.
CountedRun withMistake(const std::string& mistake) {
  CountedRun run = countTicks({.seconds = 1.5, .model = {}, .mistake = mistake});
  std::cout << table(run);
  return run;
}

TEST(WrongTick, OneThatAllocatesIsFound) {
  const CountedRun run = withMistake("malloc");
  EXPECT_GT(run.of(Kind::kAllocation), 0);
  EXPECT_GT(run.of(Kind::kFree), 0);
  EXPECT_EQ(run.of(Kind::kLock), 0);
}

TEST(WrongTick, OneThatTakesAMutexIsFound) {
  const CountedRun run = withMistake("lock");
  EXPECT_GT(run.of(Kind::kLock), 0);
  EXPECT_EQ(run.of(Kind::kAllocation), 0);
}

TEST(WrongTick, OneThatTouchesAFreshPageIsFound) {
  const CountedRun run = withMistake("fault");
  EXPECT_GT(run.faults(), 0);
  EXPECT_EQ(run.of(Kind::kAllocation) + run.of(Kind::kLock), 0);
}

TEST(WrongTick, OneThatSleepsTwiceIsFound) {
  const CountedRun run = withMistake("sleep");
  EXPECT_GT(run.of(Kind::kWait), 0);
  EXPECT_GT(run.usage.voluntary, run.sleeps);
}

}  // namespace
}  // namespace palpate::proof
