// SPDX-License-Identifier: Apache-2.0
#include "late_log.h"

#include <gtest/gtest.h>

namespace palpate::proof {
namespace {

TEST(LateLog, HoldsLateTicksAndInjections) {
  const std::string log =
      "[2026] [palpate-server] [info] serving\n"
      "injected at 1000200 us for 5000 us\n"
      "[2026] [palpate-server] [debug] a tick due at 1000000 us ended 5300 us later: preempted by cpu-hog "
      "(7), FIFO 90\n";
  const auto told = toldTicks(log);
  ASSERT_EQ(told.size(), 1U);
  EXPECT_EQ(told[0].due_us, 1'000'000);
  EXPECT_EQ(told[0].late_us, 5300);
  EXPECT_EQ(told[0].cause, "preempted by cpu-hog (7), FIFO 90");
  const auto injected = injections(log);
  ASSERT_EQ(injected.size(), 1U);
  EXPECT_EQ(injected[0].at_us, 1'000'200);
  EXPECT_EQ(injected[0].for_us, 5000);
}

// However many other ticks had the cause.
TEST(LateLog, AnInjectionHasTheTickOfItsTime) {
  const std::vector<ToldTick> told{
      {1000, 5300, "preempted"}, {9000, 5000, "own work"}, {19000, 5000, "own work"}};
  const Named named = compare({{1200, 5000}}, told, "own work");
  EXPECT_EQ(named.clear, 1);
  EXPECT_EQ(named.right, 0);
  EXPECT_EQ(named.wrongly, "at 1200 us for 5000 us: 5300 us late, preempted\n");
  EXPECT_EQ(compare({{1200, 5000}}, told, "preempted").right, 1);
}

TEST(LateLog, AnInjectionWithoutALateTickIsNotNamedRight) {
  const Named named = compare({{50'000, 5000}}, {{1000, 5300, "own work"}}, "own work");
  EXPECT_EQ(named.clear, 1);
  EXPECT_EQ(named.right, 0);
}

TEST(LateLog, ATickThatIsLateByOtherThingsForTheMostPartSaysNothing) {
  EXPECT_EQ(compare({{1200, 5000}}, {{1000, 10'001, "preempted"}}, "own work").clear, 0);
  EXPECT_EQ(compare({{1200, 5000}}, {{1000, 10'000, "preempted"}}, "own work").clear, 1);
}

}  // namespace
}  // namespace palpate::proof
