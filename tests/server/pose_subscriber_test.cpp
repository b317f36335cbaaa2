// SPDX-License-Identifier: Apache-2.0
#include "palpate/server/pose_subscriber.h"

#include <gtest/gtest.h>

#include <chrono>
#include <memory>
#include <thread>

#include "palpate/idl/writer.h"
#include "palpate/testing/test_domain.h"

namespace palpate::server {
namespace {

constexpr std::uint64_t kFirst = 1, kNext = 2;

// Sends poses with `seq` until the newest that the tick would read is of `wanted`, for at most 20 s.
bool sendUntil(dds::Writer<dds::ToolPose>& writer, std::uint64_t seq, std::uint64_t wanted,
               Channels& channels) {
  dds::ToolPose pose{};
  pose.server_id = dds::kServerAny;
  pose.seq = seq;
  pose.orientation[3] = 1.0;
  PoseSample newest;
  for (int i = 0; i < 4000; ++i) {
    (void)writer.write(pose);
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
    (void)channels.poses[0].read(newest);
    if (newest.seq == wanted) return true;
  }
  return false;
}

// A silent publisher keeps its tool for an hour here, so that only the word of DDS that it is gone can free it.
TEST(PoseSubscriber, AToolOfAPublisherThatIsGoneGoesToTheNextWithoutASilence) {
  const auto channels = std::make_unique<Channels>();
  StepConfig config;
  config.zero_after = 3600.0;
  const dds::Participant ours(palpate::testing::exclusiveDomain());
  const dds::Participant theirs(palpate::testing::exclusiveDomain());
  const PoseSubscriber subscriber(ours, *channels, config, Address{});
  dds::Writer<dds::ToolPose> next(theirs);
  {
    dds::Writer<dds::ToolPose> first(theirs);
    ASSERT_TRUE(sendUntil(first, kFirst, kFirst, *channels));
    ASSERT_TRUE(next.waitForReaders(1, std::chrono::seconds(20)));
    EXPECT_TRUE(sendUntil(next, kNext, kFirst, *channels)) << "the first one is there, and keeps the tool";
  }
  EXPECT_TRUE(sendUntil(next, kNext, kNext, *channels));
  PoseSample newest;
  (void)channels->poses[0].read(newest);
  EXPECT_EQ(newest.handed_over, 1U);
}

}  // namespace
}  // namespace palpate::server
