// SPDX-License-Identifier: Apache-2.0
// After the start none of our code allocates. Cyclone DDS allocates in its write; the test counts how much.
#include <gtest/gtest.h>

#include <cstdio>
#include <thread>

#include "palpate/haptic/haptic_tool.h"
#include "palpate/idl/reader.h"
#include "palpate/idl/writer.h"
#include "palpate/testing/allocation_guard.h"
#include "palpate/testing/test_domain.h"

namespace palpate::testing {
namespace {

using namespace std::chrono_literals;

constexpr int kPoses = 200;

// Allocations and frees of this thread in kPoses calls, a millisecond apart.
template <class Send>
std::size_t countSending(Send&& send) {
  for (int i = 0; i < 20; ++i) send();  // what is made once, at first
  std::size_t count = 0;
  for (int i = 0; i < kPoses; ++i) {
    {
      const AllocationGuard guard;
      send();
      count += guard.count();
    }
    std::this_thread::sleep_for(1ms);
  }
  return count;
}

TEST(HapticTool, ReadingNeverAllocates) {
  const dds::Participant participant(exclusiveDomain());
  dds::Reader<dds::ToolPose> poses(participant);
  dds::Writer<dds::ToolForce> forces(participant);
  haptic::Options options;
  options.domain = exclusiveDomain();
  options.force_limit = 3.3;
  haptic::HapticTool tool(options);
  ASSERT_TRUE(tool.waitForServer(5s));
  std::size_t allocations = 0;
  int with_answer = 0;
  for (int i = 0; i < kPoses; ++i) {
    dds::ToolForce force{};
    force.pose_seq = tool.send({0, 0, 0});
    force.force[2] = 1.0;
    force.stiffness[8] = -500.0;
    ASSERT_TRUE(forces.write(force));
    std::this_thread::sleep_for(1ms);
    const AllocationGuard guard;
    const haptic::Force held = tool.force();
    const haptic::Force carried = tool.forceAt({0, 0, -0.001});
    with_answer += held.pose_seq != 0 && carried.force[2] >= held.force[2] ? 1 : 0;
    allocations += guard.count();
  }
  EXPECT_EQ(allocations, 0U);
  EXPECT_GT(with_answer, kPoses / 2);
}

TEST(AllocationGuard, SeesWhatCycloneAllocates) {
  const AllocationGuard guard;
  dds_delete_qos(dds_create_qos());
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
  EXPECT_GE(guard.count(), 2U);
#endif
}

TEST(HapticTool, SendingAllocatesNoMoreThanCycloneDoes) {
  const dds::Participant participant(exclusiveDomain());
  dds::Reader<dds::ToolPose> server(participant);
  std::size_t ours = 0, cyclones = 0;
  {
    haptic::Options options;
    options.domain = exclusiveDomain();
    options.force_limit = 3.3;
    haptic::HapticTool tool(options);
    dds::Writer<dds::ToolForce> forces(participant);
    ASSERT_TRUE(tool.waitForServer(5s));
    ours = countSending([&] { ASSERT_NE(tool.send({0, 0, 0}), 0U); });
  }
  {
    const dds::Participant other(exclusiveDomain());
    dds::Writer<dds::ToolPose> writer(other);
    ASSERT_TRUE(writer.waitForReaders(1, 5s));
    dds::ToolPose pose{};
    pose.orientation[3] = 1.0;
    cyclones = countSending([&] {
      ++pose.seq;
      ASSERT_TRUE(writer.write(pose));
    });
  }
  std::printf("allocations and frees a pose: send() %.2f, dds_write() alone %.2f\n",
              static_cast<double>(ours) / kPoses, static_cast<double>(cyclones) / kPoses);
  EXPECT_LE(ours, cyclones + kPoses / 10) << "Cyclone's own count varies a little";
}

}  // namespace
}  // namespace palpate::testing
