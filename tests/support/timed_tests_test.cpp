// SPDX-License-Identifier: Apache-2.0
// What fails while a processor stands still runs again, and nothing else does (docs/decisions/timed_tests.md).
#include <gtest/gtest.h>

#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <string>

#include "palpate/testing/files.h"
#include "palpate/testing/run_program.h"

namespace palpate::testing {
namespace {

class TimedTests : public ::testing::Test {
 protected:
  TimedTests() {
    forget();  // what this program was started with
    setenv("PALPATE_TWIN_FOLDER", folder_.path().c_str(), 1);
  }
  ~TimedTests() override { forget(); }

  static void forget() {
    for (const char* const variable :
         {"PALPATE_TWIN_FOLDER", "PALPATE_TEST_STOOD_STILL_MS", "GTEST_TOTAL_SHARDS", "GTEST_SHARD_INDEX"})
      unsetenv(variable);
  }

  // @param stood_still_ms  stalls from here on excuse; 0: any failure is excused
  [[nodiscard]] int run(const std::string& filter, const char* stood_still_ms) {
    setenv("PALPATE_TEST_STOOD_STILL_MS", stood_still_ms, 1);
    const ProgramResult result = runProgram(PALPATE_TIMED_TWIN, {"--gtest_filter=" + filter});
    said_ = result.out;
    return result.exit_code;
  }
  [[nodiscard]] std::uintmax_t runsOf(const std::string& test) const {
    return std::filesystem::exists(folder_ / test) ? std::filesystem::file_size(folder_ / test) : 0;
  }

  const TemporaryFolder folder_;
  std::string said_;
};

TEST_F(TimedTests, RunAgainWhereAProcessorStoodStill) {
  EXPECT_EQ(run("Twin.Passes:Twin.FailsAtFirst", "0"), 0);
  EXPECT_NE(said_.find("so they run again: Twin.FailsAtFirst\n"), std::string::npos) << said_;
  EXPECT_EQ(runsOf("FailsAtFirst"), 2U);
  EXPECT_EQ(runsOf("Passes"), 1U);
}

TEST_F(TimedTests, CountWhereNoneStoodStill) {
  EXPECT_EQ(run("Twin.Passes:Twin.FailsAtFirst", "1e9"), 1);
  EXPECT_EQ(runsOf("FailsAtFirst"), 1U);
}

TEST_F(TimedTests, CountAfterThreeRuns) {
  EXPECT_EQ(run("Twin.FailsThreeTimes", "0"), 1);
  EXPECT_EQ(runsOf("FailsThreeTimes"), 3U);
}

TEST_F(TimedTests, CountAtOnceWhereOneSaysSo) {
  EXPECT_EQ(run("Twin.FailsAtFirst:Twin.FailsOnceAndSaysThatItCounts", "0"), 1);
  EXPECT_EQ(runsOf("FailsOnceAndSaysThatItCounts"), 1U);
  EXPECT_EQ(runsOf("FailsAtFirst"), 1U);
}

TEST_F(TimedTests, CountAtOnceWhereTheirSuiteWasNotPrepared) {
  EXPECT_EQ(run("PreparedTwin.*:Twin.FailsAtFirst", "0"), 1);
  EXPECT_EQ(runsOf("FailsAtFirst"), 1U);
}

TEST_F(TimedTests, RunAgainInTheEnvironmentThatTheProgramHad) {
  EXPECT_EQ(run("Twin.ChangesItsEnvironmentAndFailsAtFirst", "0"), 0) << said_;
}

TEST_F(TimedTests, CountAtOnceWhereTheFirstFailureEndsAll) {
  setenv("GTEST_FAIL_FAST", "1", 1);
  EXPECT_EQ(run("Twin.Passes:Twin.FailsAtFirst", "0"), 1);
  unsetenv("GTEST_FAIL_FAST");
}

TEST_F(TimedTests, AreNotSkippedInTheirSecondRun) {
  EXPECT_EQ(run("Twin.FailsAtFirstAndIsSkippedThen", "0"), 1);
  EXPECT_EQ(runsOf("FailsAtFirstAndIsSkippedThen"), 2U);
}

TEST_F(TimedTests, OfAShardRunAgain) {
  setenv("GTEST_TOTAL_SHARDS", "2", 1);
  for (const char* const shard : {"0", "1"}) {
    setenv("GTEST_SHARD_INDEX", shard, 1);
    EXPECT_EQ(run("Twin.Passes:Twin.FailsAtFirst", "0"), 0) << said_;
  }
  EXPECT_EQ(runsOf("FailsAtFirst"), 2U);
  EXPECT_EQ(runsOf("Passes"), 1U);
}

}  // namespace
}  // namespace palpate::testing
