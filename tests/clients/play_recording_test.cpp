// SPDX-License-Identifier: Apache-2.0
// Which forces of a recording and of its playback are compared, and how far they are apart. The rest needs a server:
// played_session_test.cpp.
#include "play_recording.h"

#include <gtest/gtest.h>

#include <tuple>
#include <vector>

#include "recording_report.h"

namespace palpate::tool {
namespace {

constexpr std::uint32_t kFree = dds::tool_state::kFree, kStick = dds::tool_state::kStick,
                        kSlide = dds::tool_state::kSlide;

RecordedPose recorded(std::uint32_t state, std::uint32_t flags = 0, double force = 1.0) {
  RecordedPose pose;
  pose.state = state;
  pose.flags = flags;
  pose.force = {0.0, 0.0, force};
  return pose;
}
dds::ToolForce now(std::uint32_t state, std::uint32_t flags = 0, double size = 1.0) {
  dds::ToolForce force{};
  force.state = state;
  force.flags = flags;
  force.force[2] = size;
  return force;
}

TEST(StallMemory, AContactThatRampsInBothIsNoStall) {
  StallMemory stalls;
  EXPECT_FALSE(stalls.add(false, 0, recorded(kStick, dds::flag::kRamping), now(kStick, dds::flag::kRamping)));
  EXPECT_FALSE(stalls.add(false, 0, recorded(kStick), now(kStick)));
}

TEST(StallMemory, WhatOnlyOneServerBlendsIsForgottenWhenNothingPressesInBoth) {
  StallMemory stalls;
  EXPECT_TRUE(stalls.add(false, 0, recorded(kStick), now(kStick, dds::flag::kRamping)));
  EXPECT_TRUE(stalls.add(false, 0, recorded(kStick), now(kStick))) << "the anchor may be another one";
  EXPECT_TRUE(stalls.add(false, 0, recorded(kFree, 0, 0.0), now(kStick)));
  EXPECT_FALSE(stalls.add(false, 0, recorded(kFree, 0, 0.0), now(kStick, 0, 0.0009)));
  EXPECT_FALSE(stalls.add(false, 0, recorded(kStick), now(kStick)));
}

TEST(StallMemory, ASlideForgetsToo) {
  StallMemory stalls;
  dds::ToolForce slides = now(kSlide);
  slides.anchor[0] = 1e-5;  // m, from the recorded one
  EXPECT_TRUE(stalls.add(true, 0, recorded(kSlide), slides));
  for (int i = 0; i < 99; ++i) EXPECT_TRUE(stalls.add(false, 0, recorded(kSlide), slides)) << i;
  EXPECT_FALSE(stalls.add(false, 0, recorded(kSlide), slides));
}

TEST(StallMemory, ContactsThatHoldTheSamePointAreTheSame) {
  StallMemory stalls;
  dds::ToolForce here = now(kStick), beside = here;
  beside.anchor[1] = 3e-6;
  EXPECT_TRUE(stalls.add(true, 0, recorded(kStick), here));
  for (int i = 0; i < 50; ++i) EXPECT_TRUE(stalls.add(false, 0, recorded(kStick), beside)) << i;
  for (int i = 0; i < 9; ++i) EXPECT_TRUE(stalls.add(false, 0, recorded(kStick), here)) << i;
  EXPECT_TRUE(stalls.add(false, 0, recorded(kStick), beside)) << "not ten in a row";
  for (int i = 0; i < 20; ++i)
    EXPECT_TRUE(
        stalls.add(false, 0, recorded(kStick, dds::flag::kRamping), now(kStick, dds::flag::kRamping)));
  for (int i = 0; i < 9; ++i) EXPECT_TRUE(stalls.add(false, 0, recorded(kStick), here)) << i;
  EXPECT_FALSE(stalls.add(false, 0, recorded(kStick), here));
}

TEST(StallMemory, AShortStallIsForgottenSoon) {
  RecordedPose late = recorded(kStick);
  late.late = true;
  dds::ToolForce late_now = now(kStick);
  late_now.wakeup_ns = 600'000;
  const std::vector<std::tuple<std::uint64_t, RecordedPose, dds::ToolForce>> jolts{
      {2, recorded(kStick), now(kStick)}, {0, late, now(kStick)}, {0, recorded(kStick), late_now}};
  for (const auto& [skipped, then, answer] : jolts) {
    StallMemory stalls;
    EXPECT_FALSE(stalls.add(false, 1, recorded(kStick), now(kStick)))
        << "one pose is superseded now and then";
    EXPECT_TRUE(stalls.add(false, skipped, then, answer));
    RecordedPose after = recorded(kStick);
    after.t_ns = 9'999'999;
    EXPECT_TRUE(stalls.add(false, 0, after, now(kStick)));
    after.t_ns = 10'000'000;
    EXPECT_FALSE(stalls.add(false, 0, after, now(kStick)));
  }
}

// Answers to a press of 2 N with one that is off, and one of a stall that is further off.
ReplayedTool someTool(const std::vector<RecordedPose>& poses) {
  ReplayedTool tool;
  tool.sent = poses.size();
  for (const RecordedPose& pose : poses) tool.poses.push_back({&pose, {}, true});
  for (ReplayedPose& pose : tool.poses)
    for (std::size_t k = 0; k < 3; ++k) pose.now.force[k] = pose.recorded->force[k];
  tool.poses[1].now.force[0] += 0.03;
  tool.poses[2].now.force[0] += 0.5;
  tool.poses[2].compared = false;
  return tool;
}

TEST(ReplayedTool, IsJudgedByTheLargestDifferenceThatIsCompared) {
  std::vector<RecordedPose> poses(4);
  for (RecordedPose& pose : poses) pose.force = {0.0, 0.0, 2.0};
  const ReplayedTool tool = someTool(poses);
  EXPECT_EQ(tool.compared(), 3U);
  EXPECT_EQ(tool.largestRecorded(), 2.0);
  EXPECT_EQ(tool.worst(), &tool.poses[1]);
  EXPECT_NEAR(tool.worst()->difference(), 0.03, 1e-12);
  EXPECT_TRUE(tool.within(0.016));
  EXPECT_FALSE(tool.within(0.014));
}

TEST(ReplayedTool, IsNotCalledTheSameWhereLessThanHalfIsCompared) {
  std::vector<RecordedPose> poses(4);
  for (RecordedPose& pose : poses) pose.force = {0.0, 0.0, 2.0};
  ReplayedTool tool = someTool(poses);
  tool.poses[0].compared = false;
  EXPECT_TRUE(tool.within(0.016)) << "half of them are";
  tool.sent = 5;
  EXPECT_FALSE(tool.within(0.016)) << "a pose without an answer counts";
  tool.sent = 4;
  tool.poses[1].compared = false;
  EXPECT_FALSE(tool.within(1.0));
  tool.poses.clear();
  EXPECT_FALSE(tool.within(1.0));
  EXPECT_EQ(tool.worst(), nullptr);
}

TEST(PlayedBack, IsJudgedWhenOneOrganAnsweredAllOfASessionThatTouchedIt) {
  std::vector<RecordedPose> poses(4);
  for (RecordedPose& pose : poses) pose.force = {0.0, 0.0, 2.0};
  const RecordedSession session;
  const client::ServerInfo server;
  Playback whole;
  whole.tools.push_back(someTool(poses));
  const auto holds = [&](const Playback& playback) {
    const PlayedBack played{"session.rec", session, playback, server, 0.016};
    EXPECT_TRUE(played.isJudged() || !played.holds());
    return played.holds();
  };
  EXPECT_TRUE(holds(whole));
  Playback early = whole;
  early.interrupted = true;
  EXPECT_FALSE(holds(early));
  Playback left = whole;
  left.server_left = true;
  EXPECT_FALSE(holds(left));
  Playback swapped = whole;
  swapped.model_changes = 1;
  EXPECT_FALSE(holds(swapped));
  for (RecordedPose& pose : poses) pose.force = {};
  Playback in_air;
  in_air.tools.push_back(someTool(poses));
  in_air.tools[0].poses[1].now = {};
  EXPECT_FALSE(holds(in_air));
}

}  // namespace
}  // namespace palpate::tool
