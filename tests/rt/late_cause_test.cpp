// SPDX-License-Identifier: Apache-2.0
#include "palpate/rt/late_cause.h"

#include <gtest/gtest.h>

#include "palpate/rt/clock.h"

namespace palpate::rt {
namespace {

LateFacts lateBy(std::int64_t span_ns) {
  LateFacts facts;
  facts.span_ns = span_ns;
  facts.cpu_ns = 60'000;  // what a tick computes anyway
  return facts;
}

TEST(CauseOf, OwnWorkWhereTheCycleRan) {
  LateFacts facts = lateBy(5 * kMs);
  facts.cpu_ns = 4 * kMs;
  EXPECT_EQ(causeOf(facts), LateCause::kOwnWork);
  facts.minor_faults = 3;  // 30 us at most
  EXPECT_EQ(causeOf(facts), LateCause::kOwnWork);
}

TEST(CauseOf, PageFaultWhereFaultsCanMakeHalfOfWhatItRan) {
  LateFacts facts = lateBy(5 * kMs);
  facts.cpu_ns = 4 * kMs;
  facts.minor_faults = 199;
  EXPECT_EQ(causeOf(facts), LateCause::kOwnWork);
  facts.minor_faults = 200;
  EXPECT_EQ(causeOf(facts), LateCause::kPageFault);
}

TEST(CauseOf, PageFaultWhereReadsCanMakeHalfOfWhatItRan) {
  LateFacts facts;
  facts.span_ns = 5'400'000;
  facts.cpu_ns = 5'200'000;
  facts.major_faults = 5;
  EXPECT_EQ(causeOf(facts), LateCause::kOwnWork);
  facts.major_faults = 25;  // or fewer, on a busy host: docs/decisions/late_ticks.md
  EXPECT_EQ(causeOf(facts), LateCause::kPageFault);
}

TEST(CauseOf, PageFaultWhereItWaitedForAPage) {
  LateFacts facts = lateBy(5 * kMs);
  facts.major_faults = 1;
  facts.extra_waits = 1;
  EXPECT_EQ(causeOf(facts), LateCause::kPageFault);
}

TEST(CauseOf, PreemptedWhereItWasReadyToRun) {
  LateFacts facts = lateBy(5 * kMs);
  facts.queued_ns = 4 * kMs;
  EXPECT_EQ(causeOf(facts), LateCause::kPreempted);
}

TEST(CauseOf, StoppedWhereItWaitedOnceMoreThanItSleeps) {
  LateFacts facts = lateBy(5 * kMs);
  facts.extra_waits = 1;
  facts.stolen = true;  // as well, somewhere within the second
  EXPECT_EQ(causeOf(facts), LateCause::kStopped);
}

TEST(CauseOf, HostStealWhereNothingElseExplainsItAndTheHostTookTime) {
  LateFacts facts = lateBy(5 * kMs);
  facts.stolen = true;
  EXPECT_EQ(causeOf(facts), LateCause::kHostSteal);
}

TEST(CauseOf, UnknownWhereNothingExplainsIt) {
  EXPECT_EQ(causeOf(lateBy(5 * kMs)), LateCause::kUnknown);
  EXPECT_EQ(causeOf({}), LateCause::kUnknown);
}

TEST(CauseOf, ClockStepWhereTheClockLeapt) {
  LateFacts facts = lateBy(5 * kMs);
  facts.leapt_ns = 4 * kMs;
  facts.stolen = true;
  EXPECT_EQ(causeOf(facts), LateCause::kClockStep);
}

TEST(CauseOf, TheLargestPartDecides) {
  LateFacts facts = lateBy(10 * kMs);
  facts.queued_ns = 3 * kMs;
  facts.cpu_ns = 4 * kMs;
  EXPECT_EQ(causeOf(facts), LateCause::kOwnWork);
  facts.queued_ns = 5 * kMs;
  EXPECT_EQ(causeOf(facts), LateCause::kPreempted);
}

TEST(WordOf, EachCauseHasAWord) {
  EXPECT_STREQ(wordOf(LateCause::kUnknown), "unknown");
  EXPECT_STREQ(wordOf(LateCause::kClockStep), "clock step");
  EXPECT_STREQ(wordOf(static_cast<LateCause>(99)), "unknown");
}

}  // namespace
}  // namespace palpate::rt
