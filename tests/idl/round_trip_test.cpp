// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <limits>
#include <numeric>
#include <thread>
#include <vector>

#include "palpate/idl/error.h"
#include "palpate/idl/reader.h"
#include "palpate/idl/writer.h"
#include "test_domain.h"

namespace palpate::dds {
namespace {

using namespace std::chrono_literals;

// Repeats `attempt` until it says true: DDS delivers soon, not at once.
template <class Attempt>
bool eventually(Attempt attempt) {
  for (int i = 0; i < 2000; ++i) {
    if (attempt()) return true;
    std::this_thread::sleep_for(2ms);
  }
  return false;
}

template <class T>
struct Link {
  Participant participant{palpate::testing::exclusiveDomain()};
  Reader<T> reader{participant};
  Writer<T> writer{participant};

  void connect() {
    ASSERT_TRUE(writer.waitForReaders(1, 5s));
    ASSERT_TRUE(reader.waitForWriters(1, 5s));
  }
};

TEST(RoundTrip, PoseArrivesUnchanged) {
  Link<ToolPose> link;
  link.connect();
  const ToolPose sent{3, 1ULL << 40, -5, {0.1, -0.2, 0.3}, {0.5, -0.5, 0.5, 0.5}, 0x80000001U};
  ASSERT_TRUE(link.writer.write(sent));
  std::vector<ToolPose> got(2);
  ASSERT_TRUE(eventually([&] { return link.reader.take(got) == 1; }));
  EXPECT_EQ(got[0].tool_id, sent.tool_id);
  EXPECT_EQ(got[0].seq, sent.seq);
  EXPECT_EQ(got[0].stamp_ns, sent.stamp_ns);
  EXPECT_EQ(got[0].buttons, sent.buttons);
  for (int i = 0; i < 3; ++i) EXPECT_EQ(got[0].position[i], sent.position[i]);
  for (int i = 0; i < 4; ++i) EXPECT_EQ(got[0].orientation[i], sent.orientation[i]);
}

TEST(RoundTrip, ForceArrivesUnchanged) {
  Link<ToolForce> link;
  link.connect();
  ToolForce sent{};
  sent.tool_id = 1;
  sent.seq = 7;
  sent.pose_seq = 6;
  sent.pose_stamp_ns = 123456789012345;
  sent.stamp_ns = 42;
  sent.flags = flag::kInContact | flag::kShuttingDown;
  sent.state = tool_state::kStick;
  std::iota(sent.force, sent.force + 3, 1.0);
  std::iota(sent.torque, sent.torque + 3, 4.0);
  std::iota(sent.stiffness, sent.stiffness + 9, 10.0);
  std::iota(sent.anchor, sent.anchor + 3, 20.0);
  std::iota(sent.proxy, sent.proxy + 3, 30.0);
  std::iota(sent.displacement, sent.displacement + 3, 40.0);
  sent.domain_radius = 0.006;
  sent.penetration = -0.001;
  sent.wakeup_ns = 50000;
  sent.tick_ns = 60000;
  sent.overruns = 8;
  sent.superseded = 9;
  sent.pose_wait_ns = -10;
  ASSERT_TRUE(link.writer.write(sent));
  std::vector<ToolForce> got(1);
  ASSERT_TRUE(eventually([&] { return link.reader.take(got) == 1; }));
  // The type owns no memory and has no float rounding on the way: field by field equal, padding aside.
  EXPECT_EQ(got[0].seq, 7U);
  EXPECT_EQ(got[0].pose_seq, 6U);
  EXPECT_EQ(got[0].pose_stamp_ns, 123456789012345);
  EXPECT_EQ(got[0].stamp_ns, 42);
  EXPECT_EQ(got[0].flags, sent.flags);
  EXPECT_EQ(got[0].state, sent.state);
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(got[0].force[i], sent.force[i]);
    EXPECT_EQ(got[0].torque[i], sent.torque[i]);
    EXPECT_EQ(got[0].anchor[i], sent.anchor[i]);
    EXPECT_EQ(got[0].proxy[i], sent.proxy[i]);
    EXPECT_EQ(got[0].displacement[i], sent.displacement[i]);
  }
  for (int i = 0; i < 9; ++i) EXPECT_EQ(got[0].stiffness[i], sent.stiffness[i]);
  EXPECT_EQ(got[0].domain_radius, 0.006);
  EXPECT_EQ(got[0].penetration, -0.001);
  EXPECT_EQ(got[0].wakeup_ns, 50000);
  EXPECT_EQ(got[0].tick_ns, 60000);
  EXPECT_EQ(got[0].overruns, 8U);
  EXPECT_EQ(got[0].superseded, 9U);
  EXPECT_EQ(got[0].pose_wait_ns, -10);
}

TEST(RoundTrip, DisplacementArrivesFromTheCallersMemory) {
  Link<SurfaceDisplacement> link;
  link.connect();
  std::vector<float> field(3 * 2300);
  std::iota(field.begin(), field.end(), -100.0F);
  SurfaceDisplacement sent{};
  sent.organ_id = 2;
  assignText(sent.model_id, "0123abcd");
  sent.seq = 11;
  sent.stamp_ns = 12;
  const auto size = static_cast<std::uint32_t>(field.size());
  sent.displacement = {size, size, field.data(), false};
  ASSERT_TRUE(link.writer.write(sent));
  ASSERT_TRUE(eventually([&] {
    const auto got = link.reader.takeLoaned();
    if (got.empty()) return false;
    EXPECT_STREQ(got[0].model_id, "0123abcd");
    EXPECT_EQ(got[0].organ_id, 2U);
    EXPECT_EQ(got[0].seq, 11U);
    EXPECT_EQ(std::vector<float>(got[0].displacement._buffer,
                                 got[0].displacement._buffer + got[0].displacement._length),
              field);
    return true;
  }));
}

TEST(RoundTrip, LateJoinerGetsTheSurface) {
  const Participant participant(palpate::testing::exclusiveDomain());
  Writer<SurfaceMesh> writer(participant);
  double positions[] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
  std::uint32_t triangles[] = {0, 1, 2};
  std::uint8_t accessible[] = {1, 0, 1};
  std::int64_t tags[] = {5, 9, 7000000000};
  SurfaceMesh sent{};
  assignText(sent.model_id, "m");
  sent.positions = {9, 9, positions, false};
  sent.triangles = {3, 3, triangles, false};
  sent.accessible = {3, 3, accessible, false};
  sent.mesh_tags = {3, 3, tags, false};
  ASSERT_TRUE(writer.write(sent));
  const Reader<SurfaceMesh> late(participant);
  ASSERT_TRUE(eventually([&] {
    const auto got = late.takeLoaned();
    if (got.empty()) return false;
    EXPECT_EQ(got[0].positions._length, 9U);
    EXPECT_EQ(got[0].positions._buffer[3], 1.0);
    EXPECT_EQ(got[0].triangles._buffer[2], 2U);
    EXPECT_EQ(got[0].accessible._buffer[1], 0);
    EXPECT_EQ(got[0].mesh_tags._buffer[2], 7000000000);
    return true;
  }));
}

TEST(RoundTrip, LateJoinerGetsTheStatus) {
  const Participant participant(palpate::testing::exclusiveDomain());
  Writer<ServerStatus> writer(participant);
  ServerStatus sent{};
  sent.server_id = 4;
  sent.tip_radius = 0.005;
  sent.realtime = true;
  sent.tick_us = {1, 2, 3, 4, 5};
  sent.wakeup_us.count = 6;
  assignText(sent.message, "running");
  ASSERT_TRUE(writer.write(sent));
  const Reader<ServerStatus> late(participant);
  std::vector<ServerStatus> got(1);
  ASSERT_TRUE(eventually([&] { return late.take(got) == 1; }));
  EXPECT_EQ(got[0].server_id, 4U);
  EXPECT_EQ(got[0].tip_radius, 0.005);
  EXPECT_TRUE(got[0].realtime);
  EXPECT_FALSE(got[0].memory_locked);
  EXPECT_EQ(got[0].tick_us.max, 4.0);
  EXPECT_EQ(got[0].wakeup_us.count, 6U);
  EXPECT_STREQ(got[0].message, "running");
}

TEST(RoundTrip, AnswersInARowAllArriveAndALateJoinerGetsTheNewest) {
  Link<ServerParameters> link;
  link.connect();
  ServerParameters sent{};
  sent.friction = std::numeric_limits<double>::infinity();
  assignText(sent.message, "friction is 3");
  for (sent.request_id = 1; sent.request_id <= 5; ++sent.request_id) ASSERT_TRUE(link.writer.write(sent));
  std::vector<ServerParameters> got;
  ASSERT_TRUE(eventually([&] {
    std::vector<ServerParameters> some(kMaxTake);
    some.resize(link.reader.take(some));
    got.insert(got.end(), some.begin(), some.end());
    return got.size() == 5;
  }));
  for (std::size_t i = 0; i < got.size(); ++i) EXPECT_EQ(got[i].request_id, i + 1);
  EXPECT_EQ(got[0].friction, sent.friction);
  EXPECT_STREQ(got[0].message, "friction is 3");
  const Reader<ServerParameters> late(link.participant);
  std::vector<ServerParameters> newest(kMaxTake);
  ASSERT_TRUE(eventually([&] { return late.take(newest) == 1; }));
  EXPECT_EQ(newest[0].request_id, 5U);
}

TEST(RoundTrip, EveryToolKeepsItsOwnNewestPose) {
  Link<ToolPose> link;
  link.connect();
  for (std::uint64_t seq = 1; seq <= 3; ++seq)
    for (std::uint32_t tool = 0; tool < 4; ++tool) {
      ToolPose pose{};
      pose.tool_id = tool;
      pose.seq = 10 * tool + seq;
      ASSERT_TRUE(link.writer.write(pose));
    }
  std::vector<ToolPose> got(kMaxTake);
  std::size_t count = 0;
  ASSERT_TRUE(eventually([&] { return (count = link.reader.take(got)) == 4; }));
  for (std::size_t i = 0; i < count; ++i) EXPECT_EQ(got[i].seq, 10 * got[i].tool_id + 3);
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
  (void)one.write(ToolPose{0, 1, 0, {}, {}, 0});
  (void)two.write(ToolPose{1, 1, 0, {}, {}, 0});
  (void)one.write(ToolPose{2, 1, 0, {}, {}, 0});
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
    ASSERT_TRUE(brief.write(ToolPose{2, 1, 0, {}, {}, 0}));
    std::vector<ToolPose> got(4);
    ASSERT_TRUE(eventually([&] { return link.reader.take(got) == 1; }));
  }
  // The instance's end is an invalid sample; taking must skip it.
  std::vector<ToolPose> got(4);
  EXPECT_TRUE(eventually([&] { return link.reader.matched() == 1; }));
  EXPECT_EQ(link.reader.take(got), 0U);
}

TEST(Participant, RejectsADomainOutOfRange) {
  try {
    const Participant participant(231);
    FAIL() << "domain 231 was accepted";
  } catch (const DdsError& error) {
    EXPECT_STREQ(error.what(), "DDS domain 231 is out of range, expected 0 to 230");
  }
}

TEST(Text, IsCutToTheFieldAndTerminated) {
  char field[4] = {'x', 'x', 'x', 'x'};
  assignText(field, "abcdef");
  EXPECT_STREQ(field, "abc");
  assignText(field, "");
  EXPECT_STREQ(field, "");
}

}  // namespace
}  // namespace palpate::dds
