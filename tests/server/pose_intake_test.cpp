// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <memory>

#include "palpate/server/pose_subscriber.h"

namespace palpate::server {
namespace {

dds::ToolPose pose(std::uint32_t tool, std::uint64_t seq, std::int64_t stamp_ns) {
  dds::ToolPose sample{};
  sample.tool_id = tool;
  sample.seq = seq;
  sample.stamp_ns = stamp_ns;
  sample.position[0] = static_cast<double>(seq);
  sample.orientation[3] = 1.0;
  return sample;
}

class PoseIntakeTest : public ::testing::Test {
 protected:
  PoseSample newest(std::size_t tool) {
    PoseSample sample;
    channels_->poses[tool].read(sample);
    return sample;
  }

  std::unique_ptr<Channels> channels_ = std::make_unique<Channels>(3);
  PoseIntake intake_{*channels_};
};

TEST_F(PoseIntakeTest, HandsOverTheNewestPoseOfEachTool) {
  intake_.accept(pose(0, 1, 100), 5);
  intake_.accept(pose(0, 2, 200), 6);
  intake_.accept(pose(3, 9, 300), 7);
  const PoseSample first = newest(0);
  EXPECT_EQ(first.seq, 2U);
  EXPECT_EQ(first.stamp_ns, 200);
  EXPECT_EQ(first.arrival_ns, 6);
  EXPECT_EQ(first.position[0], 2.0);
  EXPECT_EQ(first.orientation[3], 1.0);
  EXPECT_EQ(first.received, 2U);
  EXPECT_EQ(newest(3).seq, 9U);
  EXPECT_FALSE(channels_->poses[1].update());
}

TEST_F(PoseIntakeTest, CountsPosesThatWentBackwardsAndUsesThem) {
  intake_.accept(pose(0, 5, 100), 1);
  intake_.accept(pose(0, 4, 200), 2);  // number back
  EXPECT_EQ(newest(0).unordered, 1U);
  EXPECT_EQ(newest(0).seq, 4U);
  intake_.accept(pose(0, 6, 150), 3);  // stamp back
  EXPECT_EQ(newest(0).unordered, 2U);
  intake_.accept(pose(0, 7, 0), 4);  // stamp not valid: nothing to compare
  intake_.accept(pose(0, 8, 160), 5);
  EXPECT_EQ(newest(0).unordered, 2U);
}

TEST_F(PoseIntakeTest, CountsToolsThatItDoesNotServeAndKeepsThemOut) {
  for (int i = 0; i < 100; ++i) intake_.accept(pose(4, 1, 1), 1);  // more than the ring holds
  UnknownTool unknown;
  ASSERT_TRUE(channels_->unknown_tools.pop(unknown));
  EXPECT_EQ(unknown.tool_id, 4U);
  EXPECT_EQ(unknown.count, 1U);
  while (channels_->unknown_tools.pop(unknown)) {
  }
  intake_.accept(pose(0xFFFFFFFFU, 1, 1), 1);
  ASSERT_TRUE(channels_->unknown_tools.pop(unknown));
  EXPECT_EQ(unknown.tool_id, 0xFFFFFFFFU);
  EXPECT_EQ(unknown.count, 101U) << "the total survives a full ring";
  for (auto& buffer : channels_->poses) EXPECT_FALSE(buffer.update());
}

}  // namespace
}  // namespace palpate::server
