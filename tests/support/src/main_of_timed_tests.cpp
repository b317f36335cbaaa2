// SPDX-License-Identifier: Apache-2.0
// main() of tests that wait for answers within milliseconds (docs/decisions/timed_tests.md). Tests that failed while a processor stood
// still run again, all in one process more, twice at most. One that failed although both went on counts at once, as does one that
// says so (palpate/testing/timed_tests.h).
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <thread>
#include <vector>

#include "palpate/rt/clock.h"
#include "palpate/rt/process_threads.h"
#include "palpate/testing/child_process.h"
#include "palpate/testing/stalls.h"
#include "palpate/testing/timed_tests.h"

namespace palpate::testing {
namespace {

constexpr double kStoodStill = 10.0;  // ms
constexpr int kHighest = 99;          // above all threads of the programs under test
constexpr int kRuns = 3;
constexpr auto kLastBegin =
    std::chrono::seconds(100);  // of a run after the first; ctest ends what takes too long
constexpr const char* kRunsBefore = "PALPATE_TEST_RUNS_BEFORE";

// What failed, and whether the machine went on in it or in what was prepared for its suite.
class Judge : public ::testing::EmptyTestEventListener {
 public:
  explicit Judge(double stood_still) : stood_still_(stood_still) {}

  /// Tests that may run again, as a filter; empty where another failure counts.
  [[nodiscard]] std::string excused() const {
    const bool outside = ::testing::UnitTest::GetInstance()->ad_hoc_test_result().Failed();
    return counts_ || outside ? "" : excused_;
  }
  [[nodiscard]] double longest() const { return longest_; }

 private:
  void OnTestSuiteStart(const ::testing::TestSuite&) override {
    suite_ns_ = rt::monotonicNow();
    prepared_ = false;
  }
  void OnTestStart(const ::testing::TestInfo&) override {
    test_ns_ = rt::monotonicNow();
    if (!prepared_) prepared_ms_ = stalls_.longestSince(suite_ns_);
    prepared_ = true;
  }
  void OnTestEnd(const ::testing::TestInfo& test) override {
    if (!test.result()->Failed()) return;
    std::this_thread::sleep_for(
        std::chrono::milliseconds(100));  // a processor that still stands is not seen yet
    const double ms = std::max(prepared_ms_, stalls_.longestSince(test_ns_));
    if (ms < stood_still_ || countsAlways(*test.result())) {
      counts_ = true;
      return;
    }
    if (!excused_.empty()) excused_ += ':';
    excused_.append(test.test_suite_name()).append(".").append(test.name());
    longest_ = std::max(longest_, ms);
  }
  void OnTestSuiteEnd(const ::testing::TestSuite& suite) override {
    counts_ = counts_ || suite.ad_hoc_test_result().Failed();
  }

  [[nodiscard]] static bool countsAlways(const ::testing::TestResult& result) {
    for (int i = 0; i < result.test_property_count(); ++i)
      if (result.GetTestProperty(i).key() == std::string(kCountsAlways)) return true;
    return false;
  }

  const double stood_still_;
  const Stalls stalls_{rt::usableCpus(), kHighest};
  std::int64_t suite_ns_{0}, test_ns_{0};
  bool prepared_{false};     // its suite; a test of it has begun
  double prepared_ms_{0.0};  // the longest stall meanwhile
  double longest_{0.0};      // of excused tests, ms
  bool counts_{false};       // a failure that is not excused
  std::string excused_;
};

// What the process was started with: tests change their environment.
struct Start {
  Start(int argc, char** argv) : arguments(argv + 1, argv + argc) {
    for (char** variable = environ; *variable != nullptr; ++variable) environment.emplace_back(*variable);
  }

  [[nodiscard]] int again(const std::string& filter, int runs_before) {
    clearenv();
    environment.emplace_back(kRunsBefore).append("=").append(std::to_string(runs_before));
    for (std::string& variable : environment) putenv(variable.data());
    for (const char* const half : {"GTEST_TOTAL_SHARDS", "GTEST_SHARD_INDEX"}) unsetenv(half);
    arguments.push_back("--gtest_filter=" + filter);
    return ChildProcess("/proc/self/exe", arguments, {}).waitForExit();
  }

  std::vector<std::string> arguments, environment;
  std::chrono::steady_clock::time_point time = std::chrono::steady_clock::now();
};

double number(const char* variable, double otherwise) {
  const char* const text = std::getenv(variable);
  return text == nullptr ? otherwise : std::atof(text);
}

int run(Start& start) {
  if (::testing::GTEST_FLAG(list_tests)) return RUN_ALL_TESTS();  // no threads for that
  auto* const judge = new Judge(number("PALPATE_TEST_STOOD_STILL_MS", kStoodStill));
  ::testing::UnitTest::GetInstance()->listeners().Append(judge);  // owns it
  const int runs = 1 + static_cast<int>(number(kRunsBefore, 0.0));
  const int code = RUN_ALL_TESTS();
  const std::string filter = judge->excused();
  if (code == 0 || filter.empty() || runs >= kRuns) return code;
  if (std::chrono::steady_clock::now() - start.time > kLastBegin) return code;
  // The first word keeps ctest from cutting the output of a test that passes.
  std::printf(
      "CTEST_FULL_OUTPUT\na processor stood still for up to %.0f ms while these failed, so they run again: "
      "%s\n",
      judge->longest(), filter.c_str());
  std::fflush(stdout);
  return start.again(filter, runs);  // this process ends as any other: sanitizers have the last word
}

}  // namespace
}  // namespace palpate::testing

int main(int argc, char** argv) {
  palpate::testing::Start start(argc, argv);
  ::testing::InitGoogleTest(&argc, argv);
  return palpate::testing::run(start);
}
