// SPDX-License-Identifier: Apache-2.0
#include "palpate/server/pose_subscriber.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "palpate/rt/clock.h"

namespace palpate::server {
namespace {

bool isOutOfOrder(const dds::ToolPose& pose, const PoseSample& before) noexcept {
  const bool both_stamped = pose.stamp_ns != 0 && before.stamp_ns != 0;
  return pose.seq <= before.seq || (both_stamped && pose.stamp_ns < before.stamp_ns);
}

// A velocity is optional, but not one that is no number.
bool hasBadVelocity(const dds::ToolPose& pose) noexcept {
  return pose.has_velocity && !std::all_of(std::begin(pose.velocity), std::end(pose.velocity),
                                           [](double v) { return std::isfinite(v); });
}

bool isUnknown(std::uint32_t tool_id) noexcept {
  return tool_id >= static_cast<std::uint32_t>(kMaxTools);
}

}  // namespace

std::optional<std::size_t> UnknownIds::place(std::uint32_t tool_id) noexcept PALPATE_NONBLOCKING {
  for (std::size_t i = 0; i < count_; ++i)
    if (ids_[i] == tool_id) return i;
  if (count_ == ids_.size()) return std::nullopt;
  ids_[count_] = tool_id;
  return count_++;
}

std::optional<std::int64_t> delayOf(std::int64_t sent_ns, std::int64_t now_ns) noexcept {
  constexpr std::int64_t kLongest = 10'000'000'000;  // ns
  if (sent_ns <= 0 || sent_ns > now_ns || now_ns - sent_ns >= kLongest) return std::nullopt;
  return now_ns - sent_ns;
}

bool PoseIntake::isForUs(const dds::ToolPose& pose) const noexcept PALPATE_NONBLOCKING {
  return pose.server_id == address_.server_id || (address_.answers_any && pose.server_id == dds::kServerAny);
}

bool PoseIntake::admits(const dds::ToolPose& pose) noexcept PALPATE_NONBLOCKING {
  if (!isForUs(pose)) {
    channels_.misaddressed_id.store(pose.server_id, std::memory_order_relaxed);
    channels_.misaddressed_poses.fetch_add(1, std::memory_order_relaxed);
    return false;
  }
  if (!isUnknown(pose.tool_id) || admitted_.place(pose.tool_id)) return true;
  noteUnknown(pose.tool_id);
  return false;
}

void PoseIntake::accept(const dds::ToolPose& pose, dds::WriterId writer,
                        std::int64_t arrival_ns) noexcept PALPATE_NONBLOCKING {
  if (isUnknown(pose.tool_id)) noteUnknown(pose.tool_id);
  if (pose.tool_id < tools_) {
    acceptServed(pose, writer, arrival_ns);
  } else {
    acceptStranger(pose, arrival_ns);
  }
}

void PoseIntake::noteUnknown(std::uint32_t tool_id) noexcept PALPATE_NONBLOCKING {
  channels_.unknown_id.store(tool_id, std::memory_order_relaxed);
  channels_.unknown_poses.fetch_add(1, std::memory_order_relaxed);
}

void PoseIntake::acceptStranger(const dds::ToolPose& pose,
                                std::int64_t arrival_ns) noexcept PALPATE_NONBLOCKING {
  std::size_t slot = pose.tool_id;
  if (isUnknown(pose.tool_id)) {
    const auto place = answered_.place(pose.tool_id);
    if (!place) return;
    slot = static_cast<std::size_t>(kMaxTools) + *place;
  }
  const std::uint32_t flag = isUnknown(pose.tool_id) ? kUnknownTool : kToolNotConfigured;
  strangers_[slot] = {pose.tool_id, flag, pose.seq, pose.stamp_ns, arrival_ns};
  channels_.strangers.write(strangers_);
}

bool PoseIntake::keepsOut(std::size_t tool, dds::WriterId writer,
                          std::int64_t arrival_ns) const noexcept PALPATE_NONBLOCKING {
  const PoseSample& newest = newest_[tool];
  return newest.received > 0 && owner_[tool] != writer && arrival_ns - newest.arrival_ns <= silence_ns_ &&
         left_[tool].load(std::memory_order_relaxed) != owner_[tool];
}

void PoseIntake::left(dds::WriterId writer) noexcept {
  for (std::size_t tool = 0; tool < left_.size(); ++tool)
    if (channels_.owners[tool].load(std::memory_order_relaxed) == writer)
      left_[tool].store(writer, std::memory_order_relaxed);
}

void PoseIntake::acceptServed(const dds::ToolPose& pose, dds::WriterId writer,
                              std::int64_t arrival_ns) noexcept PALPATE_NONBLOCKING {
  PoseSample& newest = newest_[pose.tool_id];
  const bool same_sender = newest.received > 0 && owner_[pose.tool_id] == writer;
  Foreign& foreign = foreign_[pose.tool_id];
  if (keepsOut(pose.tool_id, writer, arrival_ns)) {
    ++foreign.count;
    foreign.last_ns = arrival_ns;
    return;
  }
  if (same_sender && foreign.count > 0) {
    newest.foreign += foreign.count;
    newest.foreign_ns = foreign.last_ns;
  }
  foreign = {};
  // DDS lost the owner for a while and found it again: it keeps the tool until it is lost once more.
  if (same_sender && arrival_ns - newest.arrival_ns > silence_ns_)
    left_[pose.tool_id].store(0, std::memory_order_relaxed);
  const bool at_once = newest.received > 0 && !same_sender && arrival_ns - newest.arrival_ns <= silence_ns_;
  newest.handed_over += at_once ? 1 : 0;
  owner_[pose.tool_id] = writer;
  channels_.owners[pose.tool_id].store(writer, std::memory_order_relaxed);
  newest.unordered += same_sender && isOutOfOrder(pose, newest) ? 1 : 0;
  ++newest.received;
  newest.seq = pose.seq;
  newest.stamp_ns = pose.stamp_ns;
  newest.arrival_ns = arrival_ns;
  newest.buttons = pose.buttons;
  std::copy(std::begin(pose.position), std::end(pose.position), newest.position.begin());
  std::copy(std::begin(pose.orientation), std::end(pose.orientation), newest.orientation.begin());
  // The engine judges poses, and knows no velocity.
  if (hasBadVelocity(pose)) newest.position.fill(std::numeric_limits<double>::quiet_NaN());
  channels_.poses[pose.tool_id].write(newest);
}

void PoseSubscriber::onPoses(dds::ReaderView<dds::ToolPose> reader, void* context) noexcept {
  auto& self = *static_cast<PoseSubscriber*>(context);
  std::array<dds::ToolPose, dds::kMaxTake> poses;
  std::array<dds::WriterId, dds::kMaxTake> writers;
  std::array<std::int64_t, dds::kMaxTake> sent_ns;
  const std::size_t count = reader.take(poses, writers, sent_ns);
  const std::int64_t now_ns = rt::monotonicNow();
  for (std::size_t i = 0; i < count; ++i) {
    self.intake_.accept(poses[i], writers[i], now_ns);
    self.noteDelay(poses[i], writers[i], sent_ns[i]);
  }
}

// Only of the owner, of whom it is known where it runs.
void PoseSubscriber::noteDelay(const dds::ToolPose& pose, dds::WriterId writer,
                               std::int64_t sent_ns) noexcept {
  if (isUnknown(pose.tool_id) || !channels_.owner_is_here[pose.tool_id].load(std::memory_order_relaxed) ||
      channels_.owners[pose.tool_id].load(std::memory_order_relaxed) != writer)
    return;
  if (const auto delay_ns = delayOf(sent_ns, dds_time())) (void)channels_.receive_delays.push(*delay_ns);
}

void PoseSubscriber::onGone(dds::WriterId writer, void* context) noexcept {
  static_cast<PoseSubscriber*>(context)->intake_.left(writer);
}

bool PoseSubscriber::admits(const dds::ToolPose& pose, void* context) noexcept {
  return static_cast<PoseSubscriber*>(context)->intake_.admits(pose);
}

}  // namespace palpate::server
