// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <vector>

#include "link.h"

namespace palpate::dds {
namespace {

ToolPose firstPoseOf(std::uint32_t tool_id) {
  ToolPose pose{};
  pose.tool_id = tool_id;
  pose.seq = 1;
  return pose;
}

struct Sum {
  std::atomic<std::uint64_t> value{0};
};

TEST(Callback, GetsEverySampleAsItComes) {
  const Participant participant(palpate::testing::exclusiveDomain());
  Sum sum;
  const auto add = [](ReaderView<ToolPose> reader, void* context) noexcept {
    ToolPose pose{};
    while (reader.take({&pose, 1}) == 1) static_cast<Sum*>(context)->value += pose.seq;
  };
  Reader<ToolPose> original(participant, add, &sum);
  const Reader<ToolPose> reader = std::move(original);  // the binding must survive a move
  Writer<ToolPose> writer(participant);
  ASSERT_TRUE(writer.waitForReaders(1, 5s));
  ToolPose pose{};
  for (pose.seq = 1; pose.seq <= 100; ++pose.seq) ASSERT_TRUE(writer.write(pose));
  EXPECT_TRUE(eventually([&] { return sum.value == 5050; }));
}

struct Senders {
  std::atomic<std::uint64_t> seq[3]{};
  std::array<WriterId, 3> writer{};
};

struct Leaving {
  std::array<std::atomic<WriterId>, 2> sender{};
  std::atomic<WriterId> gone{0};
};

TEST(Callback, TellsWhichWriterIsGone) {
  const Participant participant(palpate::testing::exclusiveDomain());
  Leaving leaving;
  const auto note = [](ReaderView<ToolPose> reader, void* context) noexcept {
    std::array<ToolPose, 1> pose;
    std::array<WriterId, kMaxTake> writers;
    while (reader.take(pose, writers) == 1)
      static_cast<Leaving*>(context)->sender[pose[0].tool_id] = writers[0];
  };
  const auto gone = [](WriterId writer, void* context) noexcept {
    static_cast<Leaving*>(context)->gone = writer;
  };
  // The reader's status is not asked for, as in the server: that would clear what its listener counts.
  const Reader<ToolPose> reader(participant, note, &leaving, nullptr, gone);
  const Participant other(palpate::testing::exclusiveDomain());
  const auto isHeard = [&](Writer<ToolPose>& writer, std::uint32_t tool_id) {
    return eventually([&] { return writer.write(firstPoseOf(tool_id)) && leaving.sender[tool_id] != 0; });
  };
  Writer<ToolPose> stays(other);
  ASSERT_TRUE(isHeard(stays, 0));
  {
    Writer<ToolPose> leaves(other);
    ASSERT_TRUE(isHeard(leaves, 1));
    EXPECT_EQ(leaving.gone, 0U);
  }
  EXPECT_TRUE(eventually([&] { return leaving.gone != 0; }));
  EXPECT_EQ(leaving.gone, leaving.sender[1]);
}

TEST(Callback, TellsWhichWriterSentASample) {
  const Participant participant(palpate::testing::exclusiveDomain());
  Senders senders;
  const auto note = [](ReaderView<ToolPose> reader, void* context) noexcept {
    auto& self = *static_cast<Senders*>(context);
    std::array<ToolPose, 1> pose;
    std::array<WriterId, kMaxTake> writers;
    while (reader.take(pose, writers) == 1) {
      self.writer[pose[0].tool_id] = writers[0];
      self.seq[pose[0].tool_id] = pose[0].seq;
    }
  };
  const Reader<ToolPose> reader(participant, note, &senders);
  Writer<ToolPose> one(participant);
  Writer<ToolPose> two(participant);
  ASSERT_TRUE(one.waitForReaders(1, 5s) && two.waitForReaders(1, 5s));
  (void)one.write(firstPoseOf(0));
  (void)two.write(firstPoseOf(1));
  (void)one.write(firstPoseOf(2));
  ASSERT_TRUE(eventually([&] { return senders.seq[0] == 1 && senders.seq[1] == 1 && senders.seq[2] == 1; }));
  EXPECT_NE(senders.writer[0], senders.writer[1]);
  EXPECT_EQ(senders.writer[0], senders.writer[2]);
}

TEST(Callback, AFilterKeepsAFloodOfInstancesOutAndARealOneGetsIn) {
  const Participant participant(palpate::testing::exclusiveDomain());
  Sum sum;
  const auto add = [](ReaderView<ToolPose> reader, void* context) noexcept {
    ToolPose pose{};
    while (reader.take({&pose, 1}) == 1) static_cast<Sum*>(context)->value += pose.seq;
  };
  const auto admits = [](const ToolPose& pose, void*) noexcept { return pose.tool_id < 4; };
  const Reader<ToolPose> reader(participant, add, &sum, admits);
  Writer<ToolPose> writer(participant);
  ASSERT_TRUE(writer.waitForReaders(1, 5s));
  ToolPose pose{};
  pose.seq = 1;
  for (pose.tool_id = 4; pose.tool_id < 4 + 2 * kMaxInstances; ++pose.tool_id) (void)writer.write(pose);
  pose.tool_id = 3;
  pose.seq = 1000;
  ASSERT_TRUE(writer.write(pose)) << "kMaxInstances ids are in use, had they been kept";
  EXPECT_TRUE(eventually([&] { return sum.value == 1000; })) << sum.value;
}

TEST(Callback, IsNotCalledForAWriterThatOnlyLeaves) {
  Link<ToolPose> link;
  link.connect();
  {
    Writer<ToolPose> brief(link.participant);
    ASSERT_TRUE(link.reader.waitForWriters(2, 5s));
    ASSERT_TRUE(brief.write(ToolPose{}));
    std::vector<ToolPose> got(4);
    ASSERT_TRUE(eventually([&] { return link.reader.take(got) == 1; }));
  }
  // The instance's end is an invalid sample; taking must skip it.
  std::vector<ToolPose> got(4);
  EXPECT_TRUE(eventually([&] { return link.reader.matched() == 1; }));
  EXPECT_EQ(link.reader.take(got), 0U);
}

}  // namespace
}  // namespace palpate::dds
