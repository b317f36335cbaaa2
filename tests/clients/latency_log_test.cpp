// SPDX-License-Identifier: Apache-2.0
#include "latency_log.h"

#include <gtest/gtest.h>

#include <limits>

namespace palpate::latency {
namespace {

constexpr std::int64_t kPeriod = 1'000'000;
constexpr std::int64_t kPoseTime = 5'000'000'000;  // when pose 1 was stamped

dds::ToolForce answer(std::uint64_t seq, std::uint64_t pose_seq) {
  dds::ToolForce force{};
  force.seq = seq;
  force.pose_seq = pose_seq;
  force.pose_stamp_ns = kPoseTime + static_cast<std::int64_t>(pose_seq - 1) * kPeriod;
  force.wakeup_ns = 40'000;
  force.tick_ns = 60'000;
  return force;
}

std::int64_t received(const dds::ToolForce& force, std::int64_t after_ns) {
  return force.pose_stamp_ns + after_ns;
}

TEST(LatencyLog, OnlyTheFirstAnswerToAPoseIsARoundTrip) {
  LatencyLog log(kPeriod);
  log.record(true);
  const auto first = answer(1, 1);
  log.add(first, received(first, 100'000));
  const auto again = answer(2, 1);
  log.add(again, received(again, 1'100'000));
  const auto next = answer(3, 2);
  log.add(next, received(next, 200'000));
  EXPECT_EQ(log.poseToForce().count(), 2U);
  EXPECT_EQ(log.poseToForce().max(), 200'000);
  EXPECT_EQ(log.tick().count(), 3U);
  EXPECT_EQ(log.wakeup().max(), 40'000);
}

TEST(LatencyLog, AStallOfTheServerShowsAsOftenAsPosesWaitedForIt) {
  LatencyLog log(kPeriod);
  log.record(true);
  const auto before = answer(1, 1);
  log.add(before, received(before, 100'000));
  const auto after = answer(2, 6);  // 2 to 5 were superseded: the server stood still for five periods
  log.add(after, received(after, 100'000));
  EXPECT_EQ(log.answeredPoseToForce().count(), 2U);
  EXPECT_EQ(log.answeredPoseToForce().max(), 100'000) << "the stall does not show here";
  EXPECT_EQ(log.poseToForce().count(), 6U);
  EXPECT_EQ(log.poseToForce().max(), 100'000 + 4 * kPeriod);
}

TEST(LatencyLog, StampsThatNoClockShowsCountAsAnHour) {
  constexpr std::int64_t kHour = 3'600'000'000'000;
  LatencyLog log(kPeriod);
  log.record(true);
  std::uint64_t seq = 0;
  for (const std::int64_t stamp_ns :
       {std::numeric_limits<std::int64_t>::min(), std::numeric_limits<std::int64_t>::max()}) {
    ++seq;
    dds::ToolForce force = answer(seq, seq);
    force.pose_stamp_ns = stamp_ns;
    log.add(force, kPoseTime);
  }
  log.finish(kPoseTime);
  EXPECT_EQ(log.answeredPoseToForce().max(), kHour);
  EXPECT_EQ(log.answeredPoseToForce().count(), 2U);
  EXPECT_EQ(log.newestAnswerNs(), kPoseTime);
}

TEST(LatencyLog, APoseALittleLateIsNotTwo) {
  LatencyLog log(kPeriod);
  log.record(true);
  const auto first = answer(1, 1);
  log.add(first, received(first, 100'000));
  auto late = answer(2, 2);
  late.pose_stamp_ns += 7 * kPeriod / 10;
  log.add(late, received(late, 100'000));
  EXPECT_EQ(log.poseToForce().count(), 2U);
  EXPECT_EQ(log.poseToForce().max(), 100'000);
}

TEST(LatencyLog, PosesWithoutAnAnswerAtTheEndCount) {
  LatencyLog log(kPeriod);
  log.record(true);
  const auto only = answer(1, 1);
  log.add(only, received(only, 100'000));
  log.record(false);
  log.finish(only.pose_stamp_ns + 10 * kPeriod);  // nine poses later; the last two may still be on their way
  EXPECT_EQ(log.poseToForce().count(), 1U + 7U);
  EXPECT_EQ(log.poseToForce().max(), 9 * kPeriod);
  LatencyLog silent(kPeriod);
  silent.finish(kPoseTime);
  EXPECT_EQ(silent.poseToForce().count(), 0U);
}

// The stamps come from outside: no answer may keep the receive thread busy for long.
TEST(LatencyLog, AStampThatCannotBeTrueAddsABoundedNumberOfValues) {
  LatencyLog log(kPeriod);
  log.record(true);
  log.add(answer(1, 1), kPoseTime);
  auto absurd = answer(2, 2);
  absurd.pose_stamp_ns = std::numeric_limits<std::int64_t>::max() / 2;
  log.add(absurd, kPoseTime);
  EXPECT_LE(log.poseToForce().count(), 100'001U);
}

TEST(LatencyLog, TheWaitForTheTickIsTakenOutPoseByPose) {
  LatencyLog log(kPeriod);
  log.record(true);
  auto waited = answer(1, 1);  // woke 40 us late, 340 us after the pose had come
  waited.pose_wait_ns = 340'000;
  log.add(waited, received(waited, 500'000));
  auto late = answer(2, 2);  // came while the tick was being woken: no wait for the planned time
  late.pose_wait_ns = 10'000;
  log.add(late, received(late, 90'000));
  auto later = answer(3, 3);  // came after the tick woke
  later.pose_wait_ns = -1'000;
  log.add(later, received(later, 80'000));
  EXPECT_EQ(log.wait().max(), 300'000);
  EXPECT_EQ(log.wait().count(), 3U);
  EXPECT_EQ(log.poseToForceLessWait().max(), 200'000);
  EXPECT_EQ(log.poseToForceLessWait().count(), 3U);
}

// The server's times come from outside: their difference must not overflow (the sanitizer preset would see it).
TEST(LatencyLog, WaitsThatCannotBeTrueAreBounded) {
  LatencyLog log(kPeriod);
  log.record(true);
  auto endless = answer(1, 1);
  endless.pose_wait_ns = std::numeric_limits<std::int64_t>::max();
  endless.wakeup_ns = std::numeric_limits<std::int64_t>::min();
  log.add(endless, received(endless, 100'000));
  EXPECT_EQ(log.wait().max(), 7'200'000'000'000);
  auto negative = answer(2, 2);
  negative.pose_wait_ns = std::numeric_limits<std::int64_t>::min();
  negative.wakeup_ns = std::numeric_limits<std::int64_t>::max();
  log.add(negative, received(negative, 100'000));
  EXPECT_EQ(log.wait().quantile(0.1), 0);
}

TEST(LatencyLog, AnswersToPosesOlderThanTwoPeriodsAreLate) {
  LatencyLog log(kPeriod);
  log.record(true);
  const auto first = answer(1, 1);
  log.add(first, received(first, 2 * kPeriod));
  EXPECT_EQ(log.late(), 0U);
  log.add(answer(2, 1), received(first, 2 * kPeriod + 1));
  EXPECT_EQ(log.late(), 1U);
}

TEST(LatencyLog, CountsOnlyWhatHappensDuringTheMeasurement) {
  LatencyLog log(kPeriod);
  auto before = answer(1, 1);
  before.overruns = 5;
  before.superseded = 10;
  log.add(before, received(before, kPeriod));
  log.record(true);
  auto first = answer(4, 2);  // 2 and 3 were lost before the measurement began
  first.overruns = 6;
  first.superseded = 11;
  log.add(first, received(first, 1));
  auto last = answer(6, 3);
  last.overruns = 8;
  last.superseded = 15;
  log.add(last, received(last, 1));
  log.record(false);
  auto after = answer(9, 4);
  after.overruns = 100;
  log.add(after, received(after, 1));
  EXPECT_EQ(log.received(), 2U);
  EXPECT_EQ(log.lost(), 1U);
  EXPECT_EQ(log.overruns(), 2U);
  EXPECT_EQ(log.superseded(), 4U);
}

TEST(LatencyLog, AServerThatStartsAnewDoesNotMakeCountersNegative) {
  LatencyLog log(kPeriod);
  log.record(true);
  auto old_server = answer(500, 1);
  old_server.overruns = 50;
  log.add(old_server, received(old_server, 1));
  const auto new_server = answer(1, 2);
  log.add(new_server, received(new_server, 1));
  EXPECT_EQ(log.overruns(), 0U);
  EXPECT_EQ(log.restarts(), 1U);
}

TEST(LatencyLog, APoseWithoutAStampGivesNoRoundTrip) {
  LatencyLog log(kPeriod);
  log.record(true);
  dds::ToolForce unknown{};
  unknown.seq = 1;
  log.add(unknown, kPoseTime);
  EXPECT_EQ(log.poseToForce().count(), 0U);
  EXPECT_EQ(log.late(), 0U);
  EXPECT_EQ(log.received(), 1U);
}

dds::SurfaceDisplacement fieldOf(std::uint32_t tool, std::uint64_t pose_seq) {
  dds::SurfaceDisplacement field{};
  field.pose_seq[tool] = pose_seq;
  field.pose_stamp_ns[tool] = kPoseTime + static_cast<std::int64_t>(pose_seq) * kPeriod;
  return field;
}

TEST(LatencyLog, OfSeveralFieldsThatNameAPoseTheFirstCounts) {
  LatencyLog log(kPeriod);
  const auto before = fieldOf(2, 1);
  log.addField(before, 2, kPoseTime + 9 * kPeriod);
  EXPECT_EQ(log.poseToField().count(), 0U) << "not yet recording";
  log.record(true);
  log.addField(before, 2, kPoseTime + 9 * kPeriod);
  EXPECT_EQ(log.poseToField().count(), 0U) << "known from before";
  const auto next = fieldOf(2, 4);
  log.addField(next, 2, next.pose_stamp_ns[2] + 700'000);
  log.addField(next, 2, next.pose_stamp_ns[2] + 1'700'000);
  log.addField(fieldOf(1, 5), 2, kPoseTime);
  auto unstamped = fieldOf(2, 6);
  unstamped.pose_stamp_ns[2] = 0;
  log.addField(unstamped, 2, kPoseTime);
  EXPECT_EQ(log.poseToField().count(), 1U);
  EXPECT_EQ(log.poseToField().max(), 700'000);
}

}  // namespace
}  // namespace palpate::latency
