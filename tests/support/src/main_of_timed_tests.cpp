// SPDX-License-Identifier: Apache-2.0
// main() of tests that wait for answers within milliseconds: what fails while a processor stands still runs again
// (docs/decisions/timed_tests.md).
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
constexpr double kLastBegin = 100.0;  // s after the first run began; ctest's time is for all of them
constexpr const char* kRunsBefore = "PALPATE_TEST_RUNS_BEFORE";
constexpr const char* kFirstBegan = "PALPATE_TEST_FIRST_BEGAN_S";
// A processor that still stands is not seen yet.
constexpr auto kUntilSeen = std::chrono::milliseconds(100);

double number(const char* variable, double otherwise) {
  const char* const text = std::getenv(variable);
  return text == nullptr ? otherwise : std::atof(text);
}

// What failed, and whether the machine went on in it and in what was prepared for its suite.
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
    if (!prepared_) prepared_ms_ = stalls_.longest(suite_ns_, test_ns_);
    prepared_ = true;
  }
  void OnTestEnd(const ::testing::TestInfo& test) override {
    if (!test.result()->Failed()) return;
    const std::int64_t end_ns = rt::monotonicNow();
    std::this_thread::sleep_for(kUntilSeen);
    const double ms = std::max(prepared_ms_, stalls_.longest(test_ns_, end_ns));
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
  bool prepared_{false};     // the suite; a test of it has begun
  double prepared_ms_{0.0};  // the longest stall meanwhile
  double longest_{0.0};      // of excused tests, ms
  bool counts_{false};       // a failure that is not excused
  std::string excused_;
};

// What the process was started with: tests change their environment.
class Start {
 public:
  Start(int argc, char** argv) : arguments_(argv + 1, argv + argc) {
    for (char** variable = environ; *variable != nullptr; ++variable) environment_.emplace_back(*variable);
  }

  [[nodiscard]] double secondsSinceTheFirst() const { return now() - first_s_; }

  [[nodiscard]] int again(const std::string& filter, int runs_before) {
    clearenv();
    for (std::string& variable : environment_) putenv(variable.data());
    for (const char* const half : {"GTEST_TOTAL_SHARDS", "GTEST_SHARD_INDEX"}) unsetenv(half);
    setenv(kRunsBefore, std::to_string(runs_before).c_str(), 1);
    setenv(kFirstBegan, std::to_string(first_s_).c_str(), 1);
    arguments_.push_back("--gtest_filter=" + filter);
    return ChildProcess("/proc/self/exe", arguments_, {}).waitForExit();
  }

 private:
  [[nodiscard]] static double now() { return 1e-9 * static_cast<double>(rt::monotonicNow()); }

  std::vector<std::string> arguments_, environment_;
  const double first_s_ = number(kFirstBegan, now());
};

int run(Start& start) {
  if (::testing::GTEST_FLAG(list_tests)) return RUN_ALL_TESTS();  // no threads for that
  auto* const judge = new Judge(number("PALPATE_TEST_STOOD_STILL_MS", kStoodStill));
  ::testing::UnitTest::GetInstance()->listeners().Append(judge);  // owns it
  const int runs = 1 + static_cast<int>(number(kRunsBefore, 0.0));
  const int code = RUN_ALL_TESTS();
  if (runs > 1 && code == 0 && ::testing::UnitTest::GetInstance()->skipped_test_count() > 0) {
    std::puts("a test that failed was skipped when it ran again: it counts as failed");
    return 1;
  }
  const std::string filter = judge->excused();
  const bool some_left_out = ::testing::GTEST_FLAG(fail_fast);
  if (code == 0 || filter.empty() || some_left_out) return code;
  if (runs >= kRuns || start.secondsSinceTheFirst() > kLastBegin) return code;
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
  static palpate::testing::Start start(argc, argv);  // it holds the environment until the process has ended
  ::testing::InitGoogleTest(&argc, argv);
  return palpate::testing::run(start);
}
