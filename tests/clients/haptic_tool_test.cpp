// SPDX-License-Identifier: Apache-2.0
#include "palpate/haptic/haptic_tool.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <thread>

#include "palpate/idl/reader.h"
#include "palpate/idl/writer.h"
#include "palpate/testing/test_domain.h"
#include "palpate_haptic.h"

namespace palpate::haptic {
namespace {

using namespace std::chrono_literals;

// A server's ends, on a participant of their own.
struct Server {
  dds::Participant participant{palpate::testing::exclusiveDomain()};
  dds::Reader<dds::ToolPose> poses{participant};
  dds::Writer<dds::ToolForce> forces{participant};
  dds::Writer<dds::ServerStatus> statuses{participant};
  std::uint64_t seq{0};
  std::uint64_t session{1};

  void say(double force_limit) {
    dds::ServerStatus status{};
    status.state = dds::server_state::kRunning;
    status.server_id = 4;
    status.session = session;
    status.force_limit = force_limit;
    status.tip_radius[1] = 0.004;
    ASSERT_TRUE(statuses.waitForReaders(1, 5s));
    ASSERT_TRUE(statuses.write(status));
  }
  void push(std::uint64_t pose_seq, double fz, std::uint32_t flags = dds::flag::kInContact) {
    dds::ToolForce force{};
    force.server_id = 4;
    force.session = session;
    force.tool_id = 1;
    force.seq = ++seq;
    force.pose_seq = pose_seq;
    force.force[2] = fz;
    force.stiffness[8] = -500.0;
    force.flags = flags;
    force.state = dds::tool_state::kStick;
    force.anchor[0] = 0.25;
    force.proxy[1] = 0.5;
    ASSERT_TRUE(forces.write(force));
  }
};

Options onTool1() {
  Options options;
  options.domain = palpate::testing::exclusiveDomain();
  options.tool_id = 1;
  options.force_limit = 50.0;
  return options;
}

// Sends and answers until the force has its full size.
Force pressed(Server& server, HapticTool& tool, const Vec3& position, double fz) {
  Force force;
  for (int i = 0; i < 2000 && force.gain < 1.0; ++i) {
    server.push(tool.send(position), fz);
    std::this_thread::sleep_for(1ms);
    force = tool.force();
  }
  return force;
}

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

TEST(HapticC, DoesTheSame) {
  Server server;
  palpate_haptic_options options;
  palpate_haptic_default_options(&options);
  options.domain = palpate::testing::exclusiveDomain();
  options.force_limit = 50.0;
  options.tool_id = 1;
  char error[100] = "left over";
  palpate_haptic* tool = palpate_haptic_open(&options, error, sizeof error);
  ASSERT_NE(tool, nullptr) << error;
  EXPECT_STREQ(error, "");
  palpate_haptic_force force{};
  EXPECT_EQ(palpate_haptic_read(tool, &force), PALPATE_HAPTIC_NO_ANSWER);
  EXPECT_EQ(palpate_haptic_wait_for_server(tool, 5.0), PALPATE_HAPTIC_OK);
  const double position[3] = {0, 0, -0.001}, deeper[3] = {0, 0, -0.002};
  dds::ToolPose pose{};
  for (int i = 0; i < 2000 && force.gain < 1.0; ++i) {
    ASSERT_EQ(palpate_haptic_send(tool, position, nullptr, 5), PALPATE_HAPTIC_OK);
    std::this_thread::sleep_for(1ms);
    if (server.poses.take({&pose, 1}) == 1) server.push(pose.seq, 0.5);
    (void)palpate_haptic_read(tool, &force);
  }
  EXPECT_EQ(force.force[2], 0.5);
  EXPECT_EQ(force.state, static_cast<unsigned>(PALPATE_HAPTIC_STICK));
  EXPECT_EQ(force.server_id, 4U);
  EXPECT_EQ(force.session, 1U);
  EXPECT_EQ(palpate_haptic_left_out(tool), 0U);
  EXPECT_EQ(pose.buttons, 5U);
  EXPECT_EQ(pose.orientation[3], 1.0);
  EXPECT_EQ(palpate_haptic_read_at(tool, deeper, &force), PALPATE_HAPTIC_OK);
  EXPECT_NEAR(force.force[2] / force.gain, 1.0, 1e-12);
  palpate_haptic_close(tool);
}

TEST(HapticC, AnswersBadArgumentsWithACode) {
  palpate_haptic_force force{};
  const double position[3] = {0, 0, 0};
  EXPECT_EQ(palpate_haptic_send(nullptr, position, nullptr, 0), PALPATE_HAPTIC_INVALID_ARGUMENT);
  EXPECT_EQ(palpate_haptic_read(nullptr, &force), PALPATE_HAPTIC_INVALID_ARGUMENT);
  EXPECT_EQ(palpate_haptic_read_at(nullptr, position, &force), PALPATE_HAPTIC_INVALID_ARGUMENT);
  EXPECT_EQ(palpate_haptic_wait_for_server(nullptr, 1.0), PALPATE_HAPTIC_INVALID_ARGUMENT);
  EXPECT_EQ(palpate_haptic_tip_radius(nullptr), 0.0);
  EXPECT_EQ(palpate_haptic_left_out(nullptr), 0U);
  palpate_haptic_close(nullptr);
  palpate_haptic_default_options(nullptr);

  palpate_haptic_options options;
  palpate_haptic_default_options(&options);
  options.tool_id = 9;
  char error[20] = "";
  EXPECT_EQ(palpate_haptic_open(&options, error, sizeof error), nullptr);
  EXPECT_STREQ(error, "tool id is 9, expec") << "cut to the buffer, terminated";
  EXPECT_EQ(palpate_haptic_open(&options, nullptr, 0), nullptr);

  options.tool_id = 0;
  options.domain = palpate::testing::exclusiveDomain();
  EXPECT_EQ(palpate_haptic_open(&options, error, sizeof error), nullptr) << "a force limit is not assumed";
  EXPECT_STREQ(error, "force limit is miss");
  EXPECT_EQ(palpate_haptic_open(nullptr, error, sizeof error), nullptr);
  options.force_limit = 50.0;
  palpate_haptic* tool = palpate_haptic_open(&options, nullptr, 0);
  ASSERT_NE(tool, nullptr);
  EXPECT_EQ(palpate_haptic_send(tool, nullptr, nullptr, 0), PALPATE_HAPTIC_INVALID_ARGUMENT);
  EXPECT_EQ(palpate_haptic_read(tool, nullptr), PALPATE_HAPTIC_INVALID_ARGUMENT);
  EXPECT_EQ(palpate_haptic_wait_for_server(tool, -1.0), PALPATE_HAPTIC_INVALID_ARGUMENT);
  EXPECT_EQ(palpate_haptic_wait_for_server(tool, NAN), PALPATE_HAPTIC_INVALID_ARGUMENT);
  EXPECT_EQ(palpate_haptic_wait_for_server(tool, 0.01), PALPATE_HAPTIC_NO_SERVER);
  palpate_haptic_close(tool);
}

TEST(HapticC, FlagsAndStatesAreThoseOfTheWire) {
  static_assert(PALPATE_HAPTIC_FLAG_IN_CONTACT == dds::flag::kInContact &&
                PALPATE_HAPTIC_FLAG_TICK_OVERRUN == dds::flag::kTickOverrun);
  static_assert(PALPATE_HAPTIC_STICK == dds::tool_state::kStick &&
                PALPATE_HAPTIC_SLIDE == dds::tool_state::kSlide);
  for (int code = -5; code <= 3; ++code) EXPECT_NE(palpate_haptic_error_text(code), nullptr);
}

}  // namespace
}  // namespace palpate::haptic
