// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <cstdint>
#include <thread>

#include "palpate/haptic/haptic_tool.h"
#include "palpate/idl/reader.h"
#include "palpate/idl/writer.h"
#include "palpate/testing/test_domain.h"

namespace palpate::haptic {

using namespace std::chrono_literals;

// A server's ends, on a participant of their own.
struct Server {
  dds::Participant participant{palpate::testing::exclusiveDomain()};
  dds::Reader<dds::ToolPose> poses{participant};
  dds::Writer<dds::ToolForce> forces{participant};
  dds::Writer<dds::ServerStatus> statuses{participant};
  std::uint64_t seq{0};
  std::uint32_t id{4};
  std::uint64_t session{1};
  std::uint32_t organ{0};

  void say(double force_limit) {
    dds::ServerStatus status{};
    status.state = dds::server_state::kRunning;
    status.server_id = id;
    status.session = session;
    status.organ_id = organ;
    status.force_limit = force_limit;
    status.tip_radius[1] = 0.004;
    ASSERT_TRUE(statuses.waitForReaders(1, 5s));
    ASSERT_TRUE(statuses.write(status));
  }
  // Whom the newest pose is for.
  std::uint32_t addressed() {
    dds::ToolPose pose{};
    while (poses.take({&pose, 1}) == 1) {
    }
    return pose.server_id;
  }
  void push(std::uint64_t pose_seq, double fz, std::uint32_t flags = dds::flag::kInContact) {
    dds::ToolForce force{};
    force.server_id = id;
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

inline Options onTool1() {
  Options options;
  options.domain = palpate::testing::exclusiveDomain();
  options.tool_id = 1;
  options.force_limit = 50.0;
  return options;
}

// Sends and answers until the force has its full size.
inline Force pressed(Server& server, HapticTool& tool, const Vec3& position, double fz) {
  Force force;
  for (int i = 0; i < 2000 && force.gain < 1.0; ++i) {
    server.push(tool.send(position), fz);
    std::this_thread::sleep_for(1ms);
    force = tool.force();
  }
  return force;
}

}  // namespace palpate::haptic
