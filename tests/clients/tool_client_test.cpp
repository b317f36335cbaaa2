// SPDX-License-Identifier: Apache-2.0
#include "palpate/client/tool_client.h"

#include <gtest/gtest.h>
#include <sched.h>

#include <array>
#include <thread>
#include <utility>

#include "palpate/client/error.h"
#include "palpate/client/sending.h"
#include "palpate/testing/test_domain.h"

namespace palpate::client {
namespace {

using namespace std::chrono_literals;

// A server's two ends on the client's own participant: samples arrive before write() returns.
struct Ends {
  dds::Participant participant{palpate::testing::exclusiveDomain()};
  ToolClient tool{participant, 2};
  dds::Reader<dds::ToolPose> poses{participant};
  dds::Writer<dds::ToolForce> forces{participant};

  [[nodiscard]] bool hears(std::uint32_t tool_id, std::uint64_t pose_seq, std::uint64_t session = 1) {
    dds::ToolForce force{};
    force.server_id = 3;
    force.session = session;
    force.tool_id = tool_id;
    force.pose_seq = pose_seq;
    EXPECT_TRUE(forces.write(force));
    dds::ToolForce got{};
    return tool.latest(got) && got.pose_seq == pose_seq;
  }
};

TEST(ToolClient, SendsWhatItIsGiven) {
  Ends ends;
  ASSERT_TRUE(ends.tool.waitForServer(5s));
  const std::uint64_t first = ends.tool.publish({0.1, 0.2, 0.3});
  const std::uint64_t second = ends.tool.publish({1, 2, 3}, {0, 1, 0, 0}, 5);
  EXPECT_EQ(second, first + 1);
  dds::ToolPose pose{};
  ASSERT_EQ(ends.poses.take({&pose, 1}), 1U);
  EXPECT_EQ(pose.tool_id, 2U);
  EXPECT_EQ(pose.seq, second);
  EXPECT_GT(pose.stamp_ns, 0);
  EXPECT_EQ(pose.position[2], 3.0);
  EXPECT_EQ(pose.orientation[1], 1.0);
  EXPECT_EQ(pose.buttons, 5U);
}

TEST(ToolClient, HearsAnswersToItsOwnPosesOnly) {
  Ends ends;
  ASSERT_TRUE(ends.tool.waitForServer(5s));
  const std::uint64_t first = ends.tool.publish({0, 0, 0});
  const std::uint64_t last = ends.tool.publish({0, 0, 0});
  EXPECT_TRUE(ends.hears(2, first));
  EXPECT_TRUE(ends.hears(2, last));
  EXPECT_FALSE(ends.hears(2, first - 1)) << "an answer to a former sender";
  EXPECT_FALSE(ends.hears(2, last + 1)) << "an answer to another sender";
  EXPECT_FALSE(ends.hears(1, last)) << "an answer to another tool";
}

TEST(ToolClient, HoldsOnToTheServerThatAnsweredFirst) {
  Ends ends;
  ASSERT_TRUE(ends.tool.waitForServer(5s));
  const std::uint64_t seq = ends.tool.publish({0, 0, 0});
  dds::ToolPose pose{};
  ASSERT_EQ(ends.poses.take({&pose, 1}), 1U);
  EXPECT_EQ(pose.server_id, dds::kServerAny);
  EXPECT_TRUE(ends.hears(2, seq, 1));
  EXPECT_FALSE(ends.hears(2, seq, 2)) << "another run of the same server, which answers the same pose";
  EXPECT_TRUE(ends.hears(2, seq, 1));
  EXPECT_EQ(ends.tool.hold().leftOut().count, 1U);
  (void)ends.tool.publish({0, 0, 0});
  ASSERT_EQ(ends.poses.take({&pose, 1}), 1U);
  EXPECT_EQ(pose.server_id, 3U) << "its poses name it";
}

// What a program writes of the answers at a sender's priority keeps others' senders from their processor.
TEST(ToolClient, WhoHasSentIsAsUrgentAsBefore) {
  std::thread([before = sched_getscheduler(0)] {
    Ends ends;
    const ToolClient other(ends.participant, 3);
    {
      const SendingPriority priority(std::array{&std::as_const(ends.tool), &other});
      if (!priority.granted()) GTEST_SKIP() << "SCHED_FIFO is not granted here";
      EXPECT_EQ(sched_getscheduler(0), SCHED_FIFO);
    }
    EXPECT_EQ(sched_getscheduler(0), before);
  }).join();
}

TEST(ToolClient, ARestartedClientDoesNotFallBehindItsPast) {
  const dds::Participant participant(palpate::testing::exclusiveDomain());
  std::uint64_t before = 0;
  {
    ToolClient tool(participant, 0);
    for (int i = 0; i < 10; ++i) before = tool.publish({0, 0, 0});
  }
  EXPECT_GT(ToolClient(participant, 0).publish({0, 0, 0}), before);
}

TEST(ToolClient, RejectsAToolThatServersDoNotKnow) {
  const dds::Participant participant(palpate::testing::exclusiveDomain());
  try {
    const ToolClient tool(participant, 4);
    FAIL() << "tool id 4 was accepted";
  } catch (const ClientError& error) {
    EXPECT_STREQ(error.what(), "tool id is 4, expected 0 to 3");
  }
}

}  // namespace
}  // namespace palpate::client
