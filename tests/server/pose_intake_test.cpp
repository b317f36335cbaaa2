// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>

#include "palpate/rt/clock.h"
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

constexpr dds::WriterId kSender = 77;
constexpr dds::WriterId kOther = 78;
using rt::kMs;

StepConfig threeTools() {
  StepConfig config;
  config.tools = 3;
  return config;
}

class PoseIntakeTest : public ::testing::Test {
 protected:
  PoseSample newest(std::size_t tool) {
    PoseSample sample;
    channels_->poses[tool].read(sample);
    return sample;
  }

  std::unique_ptr<Channels> channels_ = std::make_unique<Channels>();
  PoseIntake intake_{*channels_, StepConfig{}};
  PoseIntake three_{*channels_, threeTools()};

  Strangers strangers() {
    Strangers seen;
    channels_->strangers.read(seen);
    return seen;
  }
};

TEST_F(PoseIntakeTest, HandsOverTheNewestPoseOfEachTool) {
  intake_.accept(pose(0, 1, 100), kSender, 5);
  intake_.accept(pose(0, 2, 200), kSender, 6);
  intake_.accept(pose(3, 9, 300), kSender, 7);
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
  intake_.accept(pose(0, 5, 100), kSender, 1);
  intake_.accept(pose(0, 4, 200), kSender, 2);  // number back
  EXPECT_EQ(newest(0).unordered, 1U);
  EXPECT_EQ(newest(0).seq, 4U);
  intake_.accept(pose(0, 6, 150), kSender, 3);  // stamp back
  EXPECT_EQ(newest(0).unordered, 2U);
  intake_.accept(pose(0, 7, 0), kSender, 4);  // stamp not valid: nothing to compare
  intake_.accept(pose(0, 8, 160), kSender, 5);
  EXPECT_EQ(newest(0).unordered, 2U);
}

TEST_F(PoseIntakeTest, ARepeatedNumberCountsAsOutOfOrderAndIsUsed) {
  intake_.accept(pose(0, 5, 100), kSender, 1);
  intake_.accept(pose(0, 5, 200), kSender, 2);
  const PoseSample sample = newest(0);
  EXPECT_EQ(sample.unordered, 1U);
  EXPECT_EQ(sample.stamp_ns, 200);
}

TEST_F(PoseIntakeTest, TheFirstPublisherKeepsItsToolWhileItsPosesCome) {
  for (std::int64_t ms = 0; ms <= 200; ms += 10) {
    intake_.accept(pose(1, 10 + static_cast<std::uint64_t>(ms), ms), kSender, ms * kMs);
    intake_.accept(pose(1, 5, 1), kOther, ms * kMs + 1);
  }
  const PoseSample sample = newest(1);
  EXPECT_EQ(sample.seq, 210U);
  EXPECT_EQ(sample.arrival_ns, 200 * kMs) << "a stranger's pose keeps nothing fresh";
  EXPECT_EQ(sample.received, 21U);
  EXPECT_EQ(sample.foreign, 20U) << "the last of them may be its next publisher's";
  EXPECT_EQ(sample.foreign_ns, 190 * kMs + 1);
  EXPECT_EQ(sample.unordered, 0U) << "a stranger's numbers are nobody's order";
}

TEST_F(PoseIntakeTest, AToolWhosePublisherFellSilentGoesToTheNext) {
  intake_.accept(pose(1, 10, 0), kSender, 0);
  intake_.accept(pose(1, 3, 0), kOther, 50 * kMs);
  EXPECT_EQ(newest(1).seq, 10U);
  intake_.accept(pose(1, 4, 0), kOther, 50 * kMs + 1);  // 50 ms are over: the force is zero
  EXPECT_EQ(newest(1).seq, 4U);
  EXPECT_EQ(newest(1).unordered, 0U) << "another sender's numbers start anywhere";
  intake_.accept(pose(1, 11, 0), kSender, 51 * kMs);  // it comes back, and finds the tool taken
  EXPECT_EQ(newest(1).seq, 4U);
  EXPECT_EQ(newest(1).foreign, 0U) << "neither sent between poses of the other";
  intake_.accept(pose(1, 5, 0), kOther, 52 * kMs);
  EXPECT_EQ(newest(1).foreign, 1U);
  EXPECT_EQ(newest(1).handed_over, 0U) << "the force was zero by then";
}

TEST_F(PoseIntakeTest, AToolWhosePublisherIsGoneGoesToTheNextAtOnce) {
  intake_.accept(pose(1, 10, 0), kSender, 0);
  intake_.accept(pose(2, 10, 0), kSender, 0);
  intake_.accept(pose(1, 3, 0), kOther, 1 * kMs);
  EXPECT_EQ(newest(1).seq, 10U) << "it is still there";
  intake_.left(kOther);
  intake_.accept(pose(1, 4, 0), kOther, 2 * kMs);
  EXPECT_EQ(newest(1).seq, 10U) << "somebody else left";
  intake_.left(kSender);
  intake_.accept(pose(1, 5, 0), kOther, 3 * kMs);
  EXPECT_EQ(newest(1).seq, 5U);
  EXPECT_EQ(newest(1).handed_over, 1U);
  EXPECT_EQ(newest(1).foreign, 0U) << "who takes over is no second publisher";
  intake_.accept(pose(1, 11, 0), kSender, 4 * kMs);
  EXPECT_EQ(newest(1).seq, 5U) << "a pose that was on its way";
  intake_.accept(pose(2, 5, 0), kOther, 5 * kMs);
  EXPECT_EQ(newest(2).handed_over, 1U) << "all its tools are free";
}

TEST_F(PoseIntakeTest, APublisherThatWasLostForAWhileKeepsItsToolOnceItSendsAgain) {
  intake_.accept(pose(1, 10, 0), kSender, 0);
  intake_.left(kSender);
  intake_.accept(pose(1, 11, 0), kSender, 10'000 * kMs);
  intake_.accept(pose(1, 3, 0), kOther, 10'001 * kMs);
  EXPECT_EQ(newest(1).seq, 11U);
  intake_.left(kSender);
  intake_.accept(pose(1, 4, 0), kOther, 10'002 * kMs);
  EXPECT_EQ(newest(1).seq, 4U) << "this time it is gone";
}

TEST_F(PoseIntakeTest, HandsOverWhichToolsGetNoForce) {
  three_.accept(pose(3, 8, 80), kSender, 1);
  three_.accept(pose(4, 9, 90), kSender, 2);
  three_.accept(pose(0xFFFFFFFFU, 10, 100), kSender, 3);
  const Strangers seen = strangers();
  EXPECT_EQ(seen[3].flags, kToolNotConfigured);
  EXPECT_EQ(seen[3].tool_id, 3U);
  EXPECT_EQ(seen[4].flags, kUnknownTool);
  EXPECT_EQ(seen[4].tool_id, 4U);
  EXPECT_EQ(seen[5].tool_id, 0xFFFFFFFFU);
  EXPECT_EQ(seen[5].seq, 10U);
  EXPECT_EQ(seen[5].stamp_ns, 100);
  EXPECT_EQ(seen[5].arrival_ns, 3);
  EXPECT_EQ(channels_->unknown_poses, 2U);
  EXPECT_EQ(channels_->unknown_id, 0xFFFFFFFFU);
  for (auto& buffer : channels_->poses) EXPECT_FALSE(buffer.update());
}

TEST_F(PoseIntakeTest, AFloodOfIdsFillsSixteenPlacesAndNoMore) {
  std::size_t admitted = 0;
  for (std::uint32_t id = 4; id < 5004; ++id) {
    if (!intake_.admits(pose(id, 1, 1))) continue;
    ++admitted;
    intake_.accept(pose(id, 1, 1), kSender, 1);
  }
  EXPECT_EQ(admitted, kMaxUnknownTools);
  EXPECT_EQ(channels_->unknown_poses, 5000U) << "each is counted";
  EXPECT_TRUE(intake_.admits(pose(19, 2, 2))) << "an id that was answered stays so";
  EXPECT_FALSE(intake_.admits(pose(20, 2, 2)));
  EXPECT_TRUE(intake_.admits(pose(0, 1, 1))) << "a real tool always gets in";
  const Strangers seen = strangers();
  EXPECT_EQ(seen.back().tool_id, 19U);
}

TEST_F(PoseIntakeTest, PosesForAnotherServerAreCountedAndNotUsed) {
  PoseIntake fifth(*channels_, StepConfig{}, {5, true});
  const auto admits = [&](PoseIntake& intake, std::uint32_t server_id) {
    dds::ToolPose sample = pose(0, 1, 1);
    sample.server_id = server_id;
    return intake.admits(sample);
  };
  EXPECT_TRUE(admits(fifth, 5));
  EXPECT_TRUE(admits(fifth, dds::kServerAny));
  EXPECT_FALSE(admits(fifth, 0));
  EXPECT_EQ(channels_->misaddressed_poses.load(), 1U);
  EXPECT_EQ(channels_->misaddressed_id.load(), 0U);
  PoseIntake addressed_only(*channels_, StepConfig{}, {5, false});
  EXPECT_TRUE(admits(addressed_only, 5));
  EXPECT_FALSE(admits(addressed_only, dds::kServerAny));
}

TEST_F(PoseIntakeTest, AVelocityThatIsNoNumberSpoilsItsPose) {
  dds::ToolPose sample = pose(0, 1, 1);
  sample.velocity[1] = std::numeric_limits<double>::infinity();
  intake_.accept(sample, kSender, 1);
  EXPECT_EQ(newest(0).position[0], 1.0) << "there is none: has_velocity is not set";
  sample.has_velocity = true;
  intake_.accept(sample, kSender, 2);
  EXPECT_TRUE(std::isnan(newest(0).position[0]));
}

}  // namespace
}  // namespace palpate::server
