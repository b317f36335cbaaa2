// SPDX-License-Identifier: Apache-2.0
#include "palpate/server/pose_subscriber.h"

#include <gtest/gtest.h>

#include <chrono>
#include <limits>
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

// Delays that came, until none has come for 0.3 s.
int takeDelays(Channels& channels) {
  std::int64_t delay_ns = 0;
  int count = 0;
  for (int quiet = 0; quiet < 6; ++quiet) {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    for (; channels.receive_delays.pop(delay_ns); quiet = 0) ++count;
  }
  return count;
}

TEST(PoseSubscriber, TellsTheDelaysOfTheOwnerOnly) {
  const auto channels = std::make_unique<Channels>();
  StepConfig config;
  config.zero_after = 3600.0;
  const dds::Participant ours(palpate::testing::exclusiveDomain());
  const dds::Participant theirs(palpate::testing::exclusiveDomain());
  const PoseSubscriber subscriber(ours, *channels, config, Address{});
  dds::Writer<dds::ToolPose> owner(theirs), other(theirs);
  ASSERT_TRUE(sendUntil(owner, kFirst, kFirst, *channels));
  ASSERT_TRUE(other.waitForReaders(1, std::chrono::seconds(20)));
  EXPECT_EQ(takeDelays(*channels), 0) << "nobody knows yet where the owner runs";
  channels->owner_is_here[0] = true;
  ASSERT_TRUE(sendUntil(owner, kFirst + 1, kFirst + 1, *channels));
  EXPECT_GT(takeDelays(*channels), 0);
  dds::ToolPose pose{};
  pose.server_id = dds::kServerAny;
  pose.seq = 100;
  pose.orientation[3] = 1.0;
  for (int i = 0; i < 20; ++i) (void)other.write(pose);
  EXPECT_EQ(takeDelays(*channels), 0) << "the other one may run anywhere";
  ASSERT_TRUE(sendUntil(owner, 200, 200, *channels));
  PoseSample newest;
  (void)channels->poses[0].read(newest);
  EXPECT_GT(newest.foreign, 0U) << "its poses had come";
}

TEST(PoseSubscriber, AStampThatIsNoTimeIsNoDelay) {
  constexpr std::int64_t kNow = 1'800'000'000'000'000'000;
  EXPECT_EQ(delayOf(kNow - 40'000, kNow), 40'000);
  EXPECT_EQ(delayOf(kNow, kNow), 0);
  for (const std::int64_t stamp :
       {std::numeric_limits<std::int64_t>::min(), std::int64_t{-1}, std::int64_t{0}, kNow - 10'000'000'000,
        kNow + 1, std::numeric_limits<std::int64_t>::max()})
    EXPECT_FALSE(delayOf(stamp, kNow)) << stamp;
}

}  // namespace
}  // namespace palpate::server
