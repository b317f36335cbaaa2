// SPDX-License-Identifier: Apache-2.0
#include "palpate/server/pose_subscriber.h"

#include <algorithm>
#include <iterator>

#include "palpate/rt/clock.h"

namespace palpate::server {
namespace {

bool wentBackwards(const dds::ToolPose& pose, const PoseSample& before) noexcept {
  if (before.received == 0) return false;
  const bool both_stamped = pose.stamp_ns != 0 && before.stamp_ns != 0;
  return pose.seq < before.seq || (both_stamped && pose.stamp_ns < before.stamp_ns);
}

}  // namespace

void PoseIntake::accept(const dds::ToolPose& pose, std::int64_t arrival_ns) noexcept PALPATE_NONBLOCKING {
  if (pose.tool_id >= static_cast<std::uint32_t>(kMaxTools)) {
    // A full ring loses nothing that matters: the next entry carries the total.
    (void)channels_.unknown_tools.push({pose.tool_id, ++unknown_tools_});
    return;
  }
  PoseSample& newest = newest_[pose.tool_id];
  newest.unordered += wentBackwards(pose, newest) ? 1 : 0;
  ++newest.received;
  newest.seq = pose.seq;
  newest.stamp_ns = pose.stamp_ns;
  newest.arrival_ns = arrival_ns;
  std::copy(std::begin(pose.position), std::end(pose.position), newest.position.begin());
  std::copy(std::begin(pose.orientation), std::end(pose.orientation), newest.orientation.begin());
  channels_.poses[pose.tool_id].write(newest);
}

void PoseSubscriber::onPoses(dds::ReaderView<dds::ToolPose> reader, void* context) noexcept {
  auto& intake = *static_cast<PoseIntake*>(context);
  std::array<dds::ToolPose, dds::kMaxTake> poses;
  const std::size_t count = reader.take(poses);
  const std::int64_t now_ns = rt::monotonicNow();
  for (std::size_t i = 0; i < count; ++i) intake.accept(poses[i], now_ns);
}

}  // namespace palpate::server
