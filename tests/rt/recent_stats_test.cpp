// SPDX-License-Identifier: Apache-2.0
#include "palpate/rt/recent_stats.h"

#include <gtest/gtest.h>

namespace palpate::rt {
namespace {

constexpr std::int64_t kSecond = 1'000'000'000;
constexpr std::int64_t kStart = 77 * kSecond;

TEST(RecentStats, ASecondCountsOnceItIsOver) {
  RecentStats recent;
  recent.goOn(kStart);
  recent.add(40);
  recent.add(60);
  recent.goOn(kStart + kSecond - 1);
  EXPECT_EQ(recent.second().count(), 0U);
  EXPECT_EQ(recent.minute().count(), 0U);
  recent.goOn(kStart + kSecond);
  EXPECT_EQ(recent.second().count(), 2U);
  EXPECT_EQ(recent.second().max(), 60);
  EXPECT_EQ(recent.minute().quantile(0.5), 40);
}

TEST(RecentStats, AMaximumIsForgottenAfterItsSecondAndItsMinute) {
  RecentStats recent;
  recent.goOn(kStart);
  recent.add(9'000);
  recent.goOn(kStart + kSecond);
  for (int second = 1; second < 60; ++second) {
    recent.add(50);
    recent.goOn(kStart + (second + 1) * kSecond);
    EXPECT_EQ(recent.second().max(), 50);
    EXPECT_EQ(recent.minute().max(), 9'000) << second;
  }
  EXPECT_EQ(recent.minute().count(), 60U);
  recent.goOn(kStart + 61 * kSecond);
  EXPECT_EQ(recent.second().count(), 0U) << "nothing came in the newest second";
  EXPECT_EQ(recent.minute().max(), 50);
  EXPECT_EQ(recent.minute().count(), 59U);
}

TEST(RecentStats, AfterALongPauseNothingIsRecent) {
  RecentStats recent;
  recent.goOn(kStart);
  recent.add(50);
  recent.goOn(kStart + 1000 * kSecond);
  EXPECT_EQ(recent.second().count(), 0U);
  EXPECT_EQ(recent.minute().count(), 0U);
  recent.add(70);
  recent.goOn(kStart + 1001 * kSecond);
  EXPECT_EQ(recent.second().max(), 70);
}

}  // namespace
}  // namespace palpate::rt
