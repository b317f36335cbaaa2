// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <numeric>
#include <vector>

#include "link.h"
#include "palpate/idl/error.h"

namespace palpate::dds {
namespace {

TEST(RoundTrip, PoseArrivesUnchanged) {
  Link<ToolPose> link;
  link.connect();
  const ToolPose sent{kServerAny,  3,    1ULL << 40,      -5, {0.1, -0.2, 0.3}, {0.5, -0.5, 0.5, 0.5},
                      0x80000001U, true, {1.0, 2.0, -3.0}};
  ASSERT_TRUE(link.writer.write(sent));
  std::vector<ToolPose> got(2);
  ASSERT_TRUE(eventually([&] { return link.reader.take(got) == 1; }));
  EXPECT_EQ(got[0].server_id, sent.server_id);
  EXPECT_EQ(got[0].tool_id, sent.tool_id);
  EXPECT_EQ(got[0].seq, sent.seq);
  EXPECT_EQ(got[0].stamp_ns, sent.stamp_ns);
  EXPECT_EQ(got[0].buttons, sent.buttons);
  EXPECT_TRUE(got[0].has_velocity);
  for (int i = 0; i < 3; ++i) EXPECT_EQ(got[0].velocity[i], sent.velocity[i]);
  for (int i = 0; i < 3; ++i) EXPECT_EQ(got[0].position[i], sent.position[i]);
  for (int i = 0; i < 4; ++i) EXPECT_EQ(got[0].orientation[i], sent.orientation[i]);
}

TEST(RoundTrip, ForceArrivesUnchanged) {
  Link<ToolForce> link;
  link.connect();
  ToolForce sent{};
  sent.server_id = 5;
  sent.tool_id = 1;
  sent.session = 0xfedcba9876543210;
  sent.model_hash = 0x0123456789abcdef;
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
  EXPECT_EQ(got[0].server_id, 5U);
  EXPECT_EQ(got[0].session, 0xfedcba9876543210);
  EXPECT_EQ(got[0].model_hash, 0x0123456789abcdefU);
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
  sent.pose_seq[3] = 13;
  sent.pose_stamp_ns[3] = -14;
  ASSERT_TRUE(link.writer.write(sent));
  ASSERT_TRUE(eventually([&] {
    const auto got = link.reader.takeLoaned();
    if (got.empty()) return false;
    EXPECT_EQ(got[0].pose_seq[3], 13U);
    EXPECT_EQ(got[0].pose_stamp_ns[3], -14);
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
  std::uint8_t clamped[] = {0, 1, 0};
  SurfaceMesh sent{};
  assignText(sent.model_id, "m");
  sent.positions = {9, 9, positions, false};
  sent.triangles = {3, 3, triangles, false};
  sent.accessible = {3, 3, accessible, false};
  sent.mesh_tags = {3, 3, tags, false};
  sent.clamped = {3, 3, clamped, false};
  Region regions[2]{};
  assignText(regions[0].name, "elsewhere");
  assignText(regions[1].name, "nodule");
  regions[1].youngs_modulus = 70e3;
  regions[1].positions = {9, 9, positions, false};
  regions[1].triangles = {3, 3, triangles, false};
  sent.regions = {2, 2, regions, false};
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
    EXPECT_EQ(got[0].clamped._buffer[1], 1);
    EXPECT_EQ(got[0].regions._length, 2U);
    EXPECT_EQ(got[0].regions._buffer[0].triangles._length, 0U);
    EXPECT_STREQ(got[0].regions._buffer[1].name, "nodule");
    EXPECT_EQ(got[0].regions._buffer[1].youngs_modulus, 70e3);
    EXPECT_EQ(got[0].regions._buffer[1].positions._buffer[7], 1.0);
    EXPECT_EQ(got[0].regions._buffer[1].triangles._buffer[2], 2U);
    return true;
  }));
}

TEST(RoundTrip, LateJoinerGetsTheStatus) {
  const Participant participant(palpate::testing::exclusiveDomain());
  Writer<ServerStatus> writer(participant);
  ServerStatus sent{};
  sent.server_id = 4;
  sent.tip_radius[2] = 0.005;
  sent.realtime = true;
  sent.tick_us = {1, 2, 3, 4, 5};
  sent.wakeup_us.count = 6;
  assignText(sent.message, "running");
  ASSERT_TRUE(writer.write(sent));
  const Reader<ServerStatus> late(participant);
  std::vector<ServerStatus> got(1);
  ASSERT_TRUE(eventually([&] { return late.take(got) == 1; }));
  EXPECT_EQ(got[0].server_id, 4U);
  EXPECT_EQ(got[0].tip_radius[2], 0.005);
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
  sent.tools[3].now.friction = std::numeric_limits<double>::infinity();
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
  EXPECT_EQ(got[0].tools[3].now.friction, sent.tools[3].now.friction);
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
