// SPDX-License-Identifier: Apache-2.0
#include "palpate/haptic/haptic_tool.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <thread>

#include "played_server.h"

namespace palpate::haptic {
namespace {

TEST(HapticTool, SendsPosesAndReadsTheirForces) {
  Server server;
  HapticTool tool(onTool1());
  ASSERT_TRUE(tool.waitForServer(5s));
  const Force force = pressed(server, tool, {0, 0, -0.001}, 0.5);
  ASSERT_EQ(force.gain, 1.0);
  EXPECT_EQ(force.force[2], 0.5);
  EXPECT_EQ(force.anchor[0], 0.25);
  EXPECT_EQ(force.proxy[1], 0.5);
  EXPECT_EQ(force.flags, dds::flag::kInContact);
  EXPECT_EQ(force.state, dds::tool_state::kStick);
  EXPECT_GT(force.pose_seq, 0U);
  EXPECT_GE(force.age_s, 0.0);
  dds::ToolPose pose{};
  ASSERT_EQ(server.poses.take({&pose, 1}), 1U);
  EXPECT_EQ(pose.tool_id, 1U);
  EXPECT_EQ(pose.position[2], -0.001);
  EXPECT_EQ(pose.orientation[3], 1.0);
}

TEST(HapticTool, SaysHowNearItCame) {
  Server server;
  HapticTool tool(onTool1());
  EXPECT_EQ(tool.nearest(), std::numeric_limits<double>::infinity());
  ASSERT_TRUE(tool.waitForServer(5s));
  ASSERT_EQ(pressed(server, tool, {0, 0, -0.001}, 0.5).gain, 1.0);
  EXPECT_EQ(tool.nearest(), 0.0);
}

TEST(HapticTool, CarriesTheForceOn) {
  Server server;
  HapticTool tool(onTool1());
  ASSERT_TRUE(tool.waitForServer(5s));
  ASSERT_EQ(pressed(server, tool, {0, 0, -0.001}, 0.5).gain, 1.0);
  const Force force = tool.forceAt({0, 0, -0.002});
  EXPECT_NEAR(force.force[2] / force.gain, 1.0, 1e-12);
}

TEST(HapticTool, KeepsTheServersLimitAndItsOwn) {
  Server server;
  Options options = onTool1();
  options.force_limit = 2.0;
  HapticTool tool(options);
  ASSERT_TRUE(tool.waitForServer(5s));
  ASSERT_EQ(pressed(server, tool, {0, 0, 0}, 40.0).gain, 1.0);
  EXPECT_LE(tool.force().force[2], 2.0);
  server.say(0.7);
  for (int i = 0; i < 500 && tool.serverForceLimit() == 0.0; ++i) std::this_thread::sleep_for(10ms);
  EXPECT_EQ(tool.serverForceLimit(), 0.7);
  EXPECT_EQ(tool.tipRadius(), 0.004);
  ASSERT_EQ(pressed(server, tool, {0, 0, 0}, 40.0).gain, 1.0);
  EXPECT_LE(tool.force().force[2], 0.7);
}

// A server that comes back under its id may have another organ.
TEST(HapticTool, TouchesTheOrganThatItWantsOnly) {
  Server server;
  Options options = onTool1();
  options.organ_id = 7;
  HapticTool tool(options);
  EXPECT_EQ(tool.send({0, 0, 0}), 0U) << "no such organ is known";
  const auto says = [&](std::uint32_t organ, bool sends) {
    server.organ = organ;
    for (int i = 0; i < 500; ++i) {
      server.say(0.7);
      if ((tool.send({0, 0, 0}) != 0) == sends) return true;
      std::this_thread::sleep_for(10ms);
    }
    return false;
  };
  EXPECT_FALSE(tool.waitForServer(50ms));
  ASSERT_TRUE(says(7, true));
  ASSERT_EQ(pressed(server, tool, {0, 0, 0}, 0.5).gain, 1.0);
  ++server.session;
  ASSERT_TRUE(says(8, false)) << "the same server, another organ";
  ASSERT_TRUE(says(7, true)) << "and back";
}

TEST(HapticTool, GoesOverToAnotherServerOfItsOrganWhenItsOwnIsGone) {
  Server server, next, stranger;
  server.organ = next.organ = 7;
  next.id = 5;
  next.session = 2;
  stranger.id = 6;
  stranger.session = 3;
  Options options = onTool1();
  options.organ_id = 7;
  HapticTool tool(options);
  stranger.say(0.6);
  for (int i = 0; i < 500 && tool.send({0, 0, 0}) == 0; ++i, std::this_thread::sleep_for(10ms))
    server.say(0.7);
  next.say(0.9);
  ASSERT_EQ(pressed(server, tool, {0, 0, 0}, 1.0).gain, 1.0);
  EXPECT_EQ(server.addressed(), 4U) << "the first that was heard";
  EXPECT_EQ(tool.serverForceLimit(), 0.7);
  Force force;
  for (int i = 0; i < 20'000 && (force.session != 2 || force.gain < 1.0); ++i) {  // the first is silent
    if (i % 100 == 0) stranger.say(0.6);
    if (i % 100 == 50) next.say(0.9);
    const std::uint64_t seq = tool.send({0, 0, 0});
    stranger.push(seq, 8.0);
    next.push(seq, 0.8);
    std::this_thread::sleep_for(1ms);
    force = tool.force();
    ASSERT_LE(force.force[2], 1.0) << "nothing of a server of another organ";
  }
  EXPECT_EQ(force.server_id, 5U);
  EXPECT_EQ(force.force[2], 0.8);
  EXPECT_EQ(next.addressed(), 5U);
  EXPECT_EQ(tool.serverForceLimit(), 0.9);
}

TEST(HapticTool, LetsGoWhenTheServerFallsSilent) {
  Server server;
  HapticTool tool(onTool1());
  ASSERT_TRUE(tool.waitForServer(5s));
  ASSERT_EQ(pressed(server, tool, {0, 0, 0}, 1.0).gain, 1.0);
  for (int i = 0; i < 60; ++i) {
    tool.send({0, 0, 0});
    std::this_thread::sleep_for(1ms);
  }
  const Force force = tool.force();
  EXPECT_EQ(force.force[2], 0.0);
  EXPECT_GE(force.age_s, 0.050);
}

TEST(HapticTool, ForcesOfAnotherServerNeverReachTheDevice) {
  Server server, rival;
  rival.session = 2;
  HapticTool tool(onTool1());
  ASSERT_TRUE(tool.waitForServer(5s));
  ASSERT_TRUE(rival.forces.waitForReaders(1, 5s));
  ASSERT_EQ(pressed(server, tool, {0, 0, 0}, 0.372).session, 1U);
  int jumps = 0;
  double before = tool.force().force[2];
  for (int i = 0; i < 300; ++i) {
    const std::uint64_t seq = tool.send({0, 0, 0});
    server.push(seq, 0.372);
    rival.push(seq, 8.614);
    std::this_thread::sleep_for(1ms);
    const Force force = tool.force();
    jumps += std::abs(force.force[2] - before) > 1.0 ? 1 : 0;
    before = force.force[2];
    EXPECT_EQ(force.server_id, 4U);
    EXPECT_EQ(force.session, 1U);
  }
  EXPECT_EQ(jumps, 0);
  EXPECT_GE(tool.leftOut(), 250U);
}

TEST(HapticTool, TheNextServersForceRisesFromZero) {
  Server server, next;
  next.session = 2;
  HapticTool tool(onTool1());
  next.say(0.9);
  ASSERT_TRUE(tool.waitForServer(5s));
  ASSERT_EQ(pressed(server, tool, {0, 0, 0}, 1.0).gain, 1.0);
  server.push(tool.send({0, 0, 0}), 1.0, dds::flag::kShuttingDown);
  Force force = tool.force();
  double before = force.force[2], steepest = 0.0;
  for (int i = 0; i < 3000 && (force.session != 2 || force.gain < 1.0); ++i) {
    next.push(tool.send({0, 0, 0}), 0.8);
    std::this_thread::sleep_for(1ms);
    force = tool.force();
    steepest = std::max(steepest, std::abs(force.force[2] - before));
    before = force.force[2];
  }
  EXPECT_EQ(force.session, 2U);
  EXPECT_EQ(force.force[2], 0.8);
  EXPECT_LT(steepest, 0.5) << "it falls to zero and rises from there";
  EXPECT_EQ(tool.serverForceLimit(), 0.9) << "the limit of the server whose forces are rendered";
}

TEST(HapticTool, AnotherWriterThatNamesTheHeldRunSetsNoLimit) {
  Server server, copy;
  HapticTool tool(onTool1());
  ASSERT_TRUE(tool.waitForServer(5s));
  server.say(0.7);
  for (int i = 0; i < 500 && tool.serverForceLimit() == 0.0; ++i) std::this_thread::sleep_for(10ms);
  copy.say(9.0);
  std::this_thread::sleep_for(50ms);
  EXPECT_EQ(tool.serverForceLimit(), 0.7);
}

TEST(HapticTool, SaysItsDeviceAgainForAServerThatBeginsLater) {
  Options options = onTool1();
  options.device = "omni";
  HapticTool tool(options);
  tool.send({0, 0, 0});
  std::this_thread::sleep_for(100ms);
  const dds::Participant later(palpate::testing::exclusiveDomain());
  const dds::Reader<dds::ToolAnnouncement> words(later);
  dds::ToolAnnouncement said{};
  for (int i = 0; i < 300 && words.take({&said, 1}) == 0; ++i, std::this_thread::sleep_for(10ms))
    tool.send({0, 0, 0});
  EXPECT_EQ(said.tool_id, 1U);
  EXPECT_EQ(said.device_force_limit, 50.0);
  EXPECT_STREQ(said.device, "omni");
}

TEST(HapticTool, RefusesOptionsOutOfRange) {
  const auto complaint = [](void (*spoil)(Options&)) -> std::string {
    Options options = onTool1();
    spoil(options);
    try {
      const HapticTool tool(options);
      return "accepted";
    } catch (const HapticError& error) {
      return error.what();
    }
  };
  EXPECT_EQ(complaint([](Options& o) { o.domain = 231; }), "domain is 231, expected 0 to 230");
  EXPECT_EQ(complaint([](Options& o) { o.tool_id = 4; }), "tool id is 4, expected 0 to 3");
  EXPECT_EQ(complaint([](Options& o) { o.force_limit = Options{}.force_limit; }),
            "force limit is missing: say the largest force that the device renders, N");
  EXPECT_EQ(complaint([](Options& o) { o.force_limit = NAN; }),
            "force limit (N) is nan, expected 0.01 to 50");
  EXPECT_EQ(complaint([](Options& o) { o.max_extrapolation = -1.0; }),
            "max extrapolation (m) is -1, expected 0 to 0.05");
  EXPECT_EQ(complaint([](Options& o) { o.receive_priority = 100; }),
            "receive priority is 100, expected 0 to 99");
}

}  // namespace
}  // namespace palpate::haptic
