// SPDX-License-Identifier: Apache-2.0
// Tests that fail as they are told, with the main() of timed tests. Each run of one adds a character to a file of its name.
#include <gtest/gtest.h>

#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include "palpate/testing/timed_tests.h"

namespace {

// How often the test that runs has begun, this time included.
std::uintmax_t begun() {
  const std::filesystem::path file = std::filesystem::path(std::getenv("PALPATE_TWIN_FOLDER")) /
                                     ::testing::UnitTest::GetInstance()->current_test_info()->name();
  std::ofstream(file, std::ios::app) << 'x';
  return std::filesystem::file_size(file);
}

TEST(Twin, Passes) {
  (void)begun();
}
TEST(Twin, FailsAtFirst) {
  EXPECT_GT(begun(), 1U);
}
TEST(Twin, FailsThreeTimes) {
  EXPECT_GT(begun(), 3U);
}
TEST(Twin, FailsOnceAndSaysThatItCounts) {
  if (begun() > 1) return;
  palpate::testing::countAlways();
  FAIL();
}
TEST(Twin, FailsAtFirstAndIsSkippedThen) {
  ASSERT_GT(begun(), 1U);
  GTEST_SKIP();
}
TEST(Twin, ChangesItsEnvironmentAndFailsAtFirst) {
  EXPECT_EQ(std::getenv("PALPATE_TWIN_LEFT"), nullptr);
  setenv("PALPATE_TWIN_LEFT", "1", 1);
  EXPECT_GT(begun(), 1U);
}

class PreparedTwin : public ::testing::Test {
 protected:
  static void SetUpTestSuite() { FAIL(); }
};
TEST_F(PreparedTwin, IsNeverReached) {}

}  // namespace
