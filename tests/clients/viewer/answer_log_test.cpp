// SPDX-License-Identifier: Apache-2.0
#include "answer_log.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <map>

namespace palpate::viewer {
namespace {

AnswerRecord answer(std::uint32_t tool, double t_us) {
  AnswerRecord record;
  record.tool_id = tool;
  record.t_us = t_us;
  return record;
}

TEST(AnswerLog, EachReaderGetsEachAnswerOnce) {
  AnswerLog log;
  std::uint64_t first = 0;
  std::uint64_t second = 0;
  std::vector<AnswerRecord> out;
  for (int i = 0; i < 10; ++i) log.add(answer(0, i));
  log.since(first, 100, out);
  EXPECT_EQ(out.size(), 10U);
  log.since(first, 100, out);
  EXPECT_TRUE(out.empty());
  log.add(answer(0, 10.0));
  log.since(first, 100, out);
  ASSERT_EQ(out.size(), 1U);
  EXPECT_EQ(out[0].t_us, 10.0);
  log.since(second, 100, out);
  EXPECT_EQ(out.size(), 11U);
}

TEST(AnswerLog, TooManyAreThinnedEvenlyForEachToolAndTheNewestStays) {
  AnswerLog log;
  for (int i = 0; i < 1000; ++i)
    for (std::uint32_t tool = 0; tool < 4; ++tool) log.add(answer(tool, i));
  std::uint64_t place = 0;
  std::vector<AnswerRecord> out;
  log.since(place, 256, out);
  EXPECT_LE(out.size(), 256U);
  std::map<std::uint32_t, std::vector<double>> times;
  for (const AnswerRecord& record : out) times[record.tool_id].push_back(record.t_us);
  ASSERT_EQ(times.size(), 4U);
  for (const auto& [tool, t] : times) {
    EXPECT_GE(t.size(), 60U);
    EXPECT_EQ(t.back(), 999.0);
    for (std::size_t i = 1; i < t.size(); ++i) EXPECT_EQ(t[i] - t[i - 1], 16.0) << "1000 in 64 places";
  }
}

TEST(AnswerLog, WhatFitsIsNotThinnedThoughOneToolHasMoreThanItsShare) {
  AnswerLog log;
  for (int i = 0; i < 246; ++i) log.add(answer(0, i));
  for (int i = 0; i < 10; ++i) log.add(answer(1, i));
  std::uint64_t place = 0;
  std::vector<AnswerRecord> out;
  log.since(place, 256, out);
  EXPECT_EQ(out.size(), 256U);
}

TEST(AnswerLog, AReaderWhoWasAwayGetsWhatIsLeft) {
  AnswerLog log;
  for (std::size_t i = 0; i < AnswerLog::kCapacity + 500; ++i) log.add(answer(0, static_cast<double>(i)));
  std::uint64_t place = 0;
  std::vector<AnswerRecord> out;
  log.since(place, AnswerLog::kCapacity, out);
  ASSERT_EQ(out.size(), AnswerLog::kCapacity);
  EXPECT_EQ(out.front().t_us, 500.0);
}

TEST(StampClock, AnotherMachinesStampsComeOutEvenlyOnThisOnesClock) {
  StampClock clock;
  constexpr std::int64_t kAhead = 7'000'000'000'000;  // of the other clock
  std::int64_t last = 0;
  for (std::int64_t i = 0; i < 5000; ++i) {
    const std::int64_t made = i * 1'000'000;
    const std::int64_t delay = 100'000 + (i % 7) * 300'000;
    const std::int64_t local = clock.toLocal(made + kAhead, made + delay);
    EXPECT_LE(local, made + delay) << "never after it came";
    if (i > 10) {
      EXPECT_NEAR(static_cast<double>(local - last), 1e6, 2e3);
      EXPECT_NEAR(static_cast<double>(local - made), 1e5, 1e4) << "late by the shortest delivery";
    }
    last = local;
  }
}

TEST(StampClock, AServerWithAnotherClockIsFollowedAtOnce) {
  StampClock clock;
  (void)clock.toLocal(1'000, 5'000'000'000);
  EXPECT_EQ(clock.toLocal(90'000'000'000'000, 6'000'000'000), 6'000'000'000);
}

// With the sanitizers: no sum overflows.
TEST(StampClock, AStampBeyondAllTimesDoesNoHarm) {
  StampClock clock;
  constexpr std::int64_t kNow = 5'000'000'000;
  for (const std::int64_t stamp : {INT64_MIN, INT64_MAX, std::int64_t{0}, INT64_MAX, INT64_MIN})
    EXPECT_EQ(clock.toLocal(stamp, kNow), kNow) << stamp;
}

}  // namespace
}  // namespace palpate::viewer
