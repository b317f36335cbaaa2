// SPDX-License-Identifier: Apache-2.0
// main() of tests in which time counts. A virtual machine that stands still for longer than they allow for makes them fail, and says
// nothing of the program: tests that failed while it did run again, in a process of their own, twice at most. One that failed
// although the machine went on counts as failed at once.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "palpate/rt/clock.h"
#include "palpate/rt/process_threads.h"
#include "palpate/testing/stalls.h"

namespace palpate::testing {
namespace {

constexpr double kStoodStill =
    10.0;  // ms; of a thread above all that the programs have, so they are not its cause
constexpr int kAboveAll = 99;
constexpr int kRuns = 3;
constexpr const char* kRunsBefore = "PALPATE_TEST_RUNS_BEFORE";

// What failed, and whether the machine went on in it or in what was prepared for its suite.
class Judge : public ::testing::EmptyTestEventListener {
 public:
  [[nodiscard]] bool allExcused() const { return counts_ == 0 && !excused_.empty(); }
  [[nodiscard]] std::string excused() const {
    std::string names;
    for (const std::string& name : excused_) names += (names.empty() ? "" : ":") + name;
    return names;
  }
  [[nodiscard]] double longest() const { return longest_; }

 private:
  void OnTestSuiteStart(const ::testing::TestSuite&) override { suite_ns_ = rt::monotonicNow(); }
  void OnTestStart(const ::testing::TestInfo&) override {
    if (suite_ns_ != 0) prepared_ms_ = stalls_.longestSince(suite_ns_);
    suite_ns_ = 0;
    test_ns_ = rt::monotonicNow();
  }
  void OnTestEnd(const ::testing::TestInfo& test) override {
    if (!test.result()->Failed()) return;
    const double stood_still = std::max(prepared_ms_, stalls_.longestSince(test_ns_));
    if (stood_still < kStoodStill) {
      ++counts_;
      return;
    }
    excused_.push_back(std::string(test.test_suite_name()) + "." + test.name());
    longest_ = std::max(longest_, stood_still);
  }
  // What fails outside of tests is never excused.
  void OnTestSuiteEnd(const ::testing::TestSuite& suite) override {
    if (suite.ad_hoc_test_result().Failed()) ++counts_;
  }

  const Stalls stalls_{rt::usableCpus(), kAboveAll};
  std::int64_t suite_ns_{0}, test_ns_{0};
  double prepared_ms_{0.0}, longest_{0.0};
  int counts_{0};
  std::vector<std::string> excused_;
};

int runsBefore() {
  const char* const runs = std::getenv(kRunsBefore);
  return runs == nullptr ? 0 : std::atoi(runs);
}

// Does not return unless it cannot.
void runAgain(const Judge& judge, char* program) {
  std::printf("the machine stood still for up to %.0f ms while these failed, so they run again: %s\n",
              judge.longest(), judge.excused().c_str());
  std::fflush(stdout);
  setenv(kRunsBefore, std::to_string(runsBefore() + 1).c_str(), 1);
  unsetenv("GTEST_TOTAL_SHARDS");  // a half of the tests was chosen already
  std::string filter = "--gtest_filter=" + judge.excused();
  char* const arguments[] = {program, filter.data(), nullptr};
  execv("/proc/self/exe", arguments);
}

}  // namespace
}  // namespace palpate::testing

int main(int argc, char** argv) {
  ::testing::InitGoogleTest(&argc, argv);
  if (::testing::GTEST_FLAG(list_tests)) return RUN_ALL_TESTS();
  auto* const judge = new palpate::testing::Judge;
  ::testing::UnitTest::GetInstance()->listeners().Append(judge);  // owns it
  const int code = RUN_ALL_TESTS();
  if (code != 0 && judge->allExcused() && palpate::testing::runsBefore() + 1 < palpate::testing::kRuns)
    palpate::testing::runAgain(*judge, argv[0]);
  return code;
}
