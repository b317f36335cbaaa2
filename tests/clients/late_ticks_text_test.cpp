// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "palpate/report/late_ticks.h"

namespace palpate::report {
namespace {

dds::LateTicks late(unsigned long long preempted, unsigned long long unknown) {
  dds::LateTicks ticks{};
  ticks.preempted = preempted;
  ticks.unknown = unknown;
  dds::assignText(ticks.preempted_by, "hog (77), FIFO 90");
  return ticks;
}

TEST(LateText, SaysTheMostFrequentCauseFirstAndWhoPreempted) {
  EXPECT_EQ(lateText({}), "none");
  EXPECT_EQ(lateText(late(2, 3)), "5: 3 unknown; 2 preempted by hog (77), FIFO 90");
  dds::LateTicks ticks{};
  ticks.own_work = 1;
  EXPECT_EQ(lateText(ticks), "1: 1 own work");
}

TEST(LateSince, IsWhatCameBetween) {
  const dds::LateTicks came = lateSince(late(2, 3), late(7, 3));
  EXPECT_EQ(came.preempted, 5U);
  EXPECT_EQ(came.unknown, 0U);
  EXPECT_STREQ(came.preempted_by, "hog (77), FIFO 90");
  EXPECT_STREQ(lateSince(late(2, 3), late(2, 4)).preempted_by, "") << "that was before";
  EXPECT_EQ(countOf(lateSince(late(9, 9), late(1, 1))), 0U) << "another run of the server";
}

TEST(LateJson, HasAKeyForEachCause) {
  const program::Json json = toJson(late(2, 3));
  EXPECT_EQ(json.size(), 8U);
  EXPECT_EQ(json["preempted"], 2);
  EXPECT_EQ(json["host_steal"], 0);
  EXPECT_EQ(json["preempted_by"], "hog (77), FIFO 90");
}

}  // namespace
}  // namespace palpate::report
