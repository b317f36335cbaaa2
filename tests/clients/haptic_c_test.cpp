// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <thread>

#include "palpate_haptic.h"
#include "played_server.h"

namespace palpate::haptic {
namespace {

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
  EXPECT_EQ(palpate_haptic_too_late(tool), 0U);
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
  EXPECT_EQ(palpate_haptic_too_late(nullptr), 0U);
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
  options.security = "/none";
  EXPECT_EQ(palpate_haptic_open(&options, error, sizeof error), nullptr);
  EXPECT_STREQ(error, "/none: No such file");
  options.security = nullptr;
  palpate_haptic* tool = palpate_haptic_open(&options, nullptr, 0);
  ASSERT_NE(tool, nullptr);
  EXPECT_EQ(palpate_haptic_send(tool, nullptr, nullptr, 0), PALPATE_HAPTIC_INVALID_ARGUMENT);
  EXPECT_EQ(palpate_haptic_read(tool, nullptr), PALPATE_HAPTIC_INVALID_ARGUMENT);
  EXPECT_EQ(palpate_haptic_wait_for_server(tool, -1.0), PALPATE_HAPTIC_INVALID_ARGUMENT);
  EXPECT_EQ(palpate_haptic_wait_for_server(tool, NAN), PALPATE_HAPTIC_INVALID_ARGUMENT);
  EXPECT_EQ(palpate_haptic_wait_for_server(tool, 0.01), PALPATE_HAPTIC_NO_SERVER);
  palpate_haptic_security_warning(tool, error, sizeof error);
  EXPECT_STREQ(error, "") << "it has no identity that could end";
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
