// SPDX-License-Identifier: Apache-2.0
#include "palpate/rt/late_judge.h"

#include <gtest/gtest.h>

#include <utility>

#include "palpate/rt/clock.h"

namespace palpate::rt {
namespace {

constexpr std::int64_t kUs = 1'000;
constexpr std::int64_t kSecond = 1'000'000'000;

// A cycle that was due at `due` and ended `late` after that; its thread ran for 60 us.
LateCycle cycleDue(std::int64_t due, std::int64_t late) {
  LateCycle cycle;
  cycle.deadline_ns = due;
  cycle.woke_ns = due + late - 60 * kUs;
  cycle.before = {due - 900 * kUs, due - 900 * kUs, due - 900 * kUs, 1 * kMs, 7, 1, 500, 0};
  cycle.ended = {due + late, due + late, due + late, 1 * kMs + 60 * kUs, 7, 1, 501, 0};
  cycle.queued_ns = 0;
  return cycle;
}

LateVerdict judged(LateJudge& judge, const LateCycle& cycle) {
  judge.add(cycle);
  const std::vector<LateVerdict> verdicts = judge.take(cycle.ended.at_ns, true);
  return verdicts.size() == 1 ? verdicts[0] : LateVerdict{};
}

TEST(LateJudge, WhatWasQueuedSinceTheSampleBeforeIsThisCyclesOwnButForTheOthersSlack) {
  LateJudge judge;
  judge.note(QueueSample{kSecond - 20 * kMs, 7 * kMs, 40 * kMs});
  LateCycle cycle = cycleDue(kSecond, 5 * kMs);
  cycle.queued_ns = 7 * kMs + 300 * kUs + 4800 * kUs;
  cycle.slack_ns = 40 * kMs + 300 * kUs;
  const LateVerdict verdict = judged(judge, cycle);
  EXPECT_EQ(verdict.facts.queued_ns, 4800 * kUs);
  EXPECT_EQ(verdict.cause, LateCause::kPreempted);
}

TEST(LateJudge, ASampleThatCameDuringTheCycleIsNotOneOfBefore) {
  LateJudge judge;
  judge.note(QueueSample{kSecond - 20 * kMs, 7 * kMs, 0});
  judge.note(QueueSample{kSecond + 4 * kMs, 11 * kMs, 0});
  LateCycle cycle = cycleDue(kSecond, 5 * kMs);
  cycle.queued_ns = 11 * kMs;
  EXPECT_EQ(judged(judge, cycle).facts.queued_ns, 4 * kMs);
}

TEST(LateJudge, TwoLateCyclesInARowEachHaveTheirOwn) {
  LateJudge judge;
  judge.note(QueueSample{kSecond - 20 * kMs, 0, 0});
  LateCycle first = cycleDue(kSecond, 5 * kMs);
  first.queued_ns = 4 * kMs;
  LateCycle second = cycleDue(kSecond + 6 * kMs, 3 * kMs);
  second.queued_ns = 4 * kMs;
  second.woke_ns = second.deadline_ns + 50 * kUs;
  second.ended.cpu_ns = second.before.cpu_ns + 3 * kMs;
  EXPECT_EQ(judged(judge, first).cause, LateCause::kPreempted);
  EXPECT_EQ(judged(judge, second).cause, LateCause::kOwnWork);
}

TEST(LateJudge, WithoutAWordOfTheKernelOnQueuesNothingIsPreempted) {
  LateJudge judge;
  judge.note(QueueSample{kSecond - 20 * kMs, -1, 0});
  LateCycle cycle = cycleDue(kSecond, 5 * kMs);
  cycle.queued_ns = -1;
  EXPECT_EQ(judged(judge, cycle).cause, LateCause::kUnknown);
}

TEST(LateJudge, WhatTheThreadIsChargedForWhileItSleepsIsNotItsWork) {
  LateJudge judge;
  LateCycle cycle = cycleDue(kSecond, 5 * kMs);
  cycle.ended.cpu_ns += 4 * kMs;  // it woke late, and computed for 60 us
  const LateVerdict verdict = judged(judge, cycle);
  EXPECT_EQ(verdict.facts.cpu_ns, 60 * kUs);
  EXPECT_EQ(verdict.cause, LateCause::kUnknown);
}

TEST(LateJudge, AStoppedProcessWaitsOnceMoreThanItSleeps) {
  LateJudge judge;
  LateCycle cycle = cycleDue(kSecond, 5 * kMs);
  EXPECT_EQ(judged(judge, cycle).facts.extra_waits, 0);
  ++cycle.ended.waits;
  EXPECT_EQ(judged(judge, cycle).cause, LateCause::kStopped);
}

TEST(LateJudge, TheHostsStealIsAwaitedUntilTheKernelHasToldIt) {
  LateJudge judge;
  judge.note(StealSample{kSecond - 15 * kMs, {5, 5}});
  judge.add(cycleDue(kSecond, 5 * kMs));
  judge.note(StealSample{kSecond + 6 * kMs, {5, 9}});
  EXPECT_TRUE(judge.take(kSecond + 7 * kMs).empty()) << "too early to tell";
  judge.note(StealSample{kSecond + 26 * kMs, {5, 10}});
  EXPECT_EQ(judge.take(kSecond + 27 * kMs).at(0).cause, LateCause::kUnknown)
      << "another processor's steal says nothing";
}

TEST(LateJudge, AStealDuringTheCycleIsItsCause) {
  LateJudge judge;
  judge.note(StealSample{kSecond - 15 * kMs, {5, 5}});
  judge.add(cycleDue(kSecond, 5 * kMs));
  judge.note(StealSample{kSecond + 26 * kMs, {6, 5}});
  EXPECT_EQ(judge.take(kSecond + 27 * kMs).at(0).cause, LateCause::kHostSteal);
}

TEST(LateJudge, StealThatComesLaterIsNotItsCause) {
  LateJudge judge;
  judge.note(StealSample{kSecond - 15 * kMs, {5, 5}});
  judge.add(cycleDue(kSecond, 5 * kMs));
  judge.note(StealSample{kSecond + 26 * kMs, {5, 5}});
  judge.note(StealSample{kSecond + 46 * kMs, {7, 5}});
  EXPECT_EQ(judge.take(kSecond + 500 * kMs).at(0).cause, LateCause::kUnknown);
}

TEST(LateJudge, StealOfASpanThatIsMuchLongerThanTheCycleIsNotItsCause) {
  for (const auto& [before, after] : {std::pair{600, 26}, std::pair{15, 600}}) {
    LateJudge judge;
    judge.note(StealSample{kSecond - before * kMs, {5, 5}});
    judge.add(cycleDue(kSecond, 5 * kMs));
    judge.note(StealSample{kSecond + after * kMs, {7, 5}});
    EXPECT_EQ(judge.take(kSecond + 700 * kMs).at(0).cause, LateCause::kUnknown);
  }
}

TEST(LateJudge, WhatIsCertainDoesNotWait) {
  LateJudge judge;
  LateCycle cycle = cycleDue(kSecond, 5 * kMs);
  cycle.woke_ns = cycle.deadline_ns;
  cycle.ended.cpu_ns += 4 * kMs;
  judge.add(cycle);
  EXPECT_EQ(judge.take(cycle.ended.at_ns).size(), 1U);
}

TEST(LateJudge, AClockThatLeapsAgainstTheCounterBelowItIsAClockStep) {
  LateJudge judge;
  LateCycle cycle = cycleDue(kSecond, 5 * kMs);
  cycle.ended.raw_ns -= 5 * kMs;
  const LateVerdict verdict = judged(judge, cycle);
  EXPECT_EQ(verdict.facts.leapt_ns, 5 * kMs);
  EXPECT_EQ(verdict.cause, LateCause::kClockStep);
  cycle.ended.raw_ns = cycle.ended.at_ns - 3 * kUs;  // slewed to another clock's rate
  EXPECT_EQ(judged(judge, cycle).facts.leapt_ns, 0);
}

TEST(LateJudge, AMachineThatSleptIsAClockStepThoughTheClockStoodStill) {
  LateJudge judge;
  LateCycle cycle = cycleDue(kSecond, 60 * kUs);
  cycle.ended.boot_ns += 3 * kSecond;
  const LateVerdict verdict = judged(judge, cycle);
  EXPECT_EQ(verdict.facts.span_ns, 3 * kSecond + 60 * kUs);
  EXPECT_EQ(verdict.cause, LateCause::kClockStep);
}

}  // namespace
}  // namespace palpate::rt
