// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <limits>
#include <memory>

#include "palpate/server/pose_subscriber.h"
#include "targets.h"

namespace palpate::fuzz {

namespace {

// Poses that go on from the one before; each part of the form leaves something of that.
dds::ToolPose poseAfter(dds::ToolPose pose, Source& source) {
  const auto form = source.get<std::uint8_t>();
  if ((form & 1) != 0) pose.tool_id = source.get<std::uint8_t>() % 6;
  if ((form & 2) != 0) pose.tool_id = source.get<std::uint32_t>();
  pose.seq += 1;
  if ((form & 4) != 0) pose.seq = source.get<std::uint64_t>();
  if ((form & 8) != 0) pose.stamp_ns = source.get<std::int64_t>();
  if ((form & 16) != 0) pose.server_id = (form & 32) != 0 ? dds::kServerAny : source.get<std::uint8_t>();
  pose.has_velocity = (form & 64) != 0;
  if (pose.has_velocity) pose.velocity[form % 3] = source.get<double>();
  if ((form & 128) != 0) {
    pose.position[form % 3] = source.get<double>();
    pose.orientation[form % 4] = source.get<double>();
    pose.buttons = source.get<std::uint8_t>();
  }
  return pose;
}

using Accepted = std::array<std::uint64_t, kMaxTools>;  // poses of each tool that is served

// What the tick would see.
void look(server::Channels& channels, const Accepted& accepted) {
  for (std::size_t tool = 0; tool < channels.poses.size(); ++tool) {
    server::PoseSample newest;
    channels.poses[tool].read(newest);
    require(newest.received + newest.foreign <= accepted[tool], "no pose is counted twice");
    require((newest.received > 0) == (accepted[tool] > 0), "the first pose of a tool is used");
    require(newest.unordered <= newest.received && newest.handed_over <= newest.received,
            "what is counted of poses has come");
    require((newest.received > 0) == (channels.owners[tool].load() != 0), "a tool that sends has an owner");
  }
  server::Strangers strangers;
  channels.strangers.read(strangers);
  for (std::size_t i = 0; i < strangers.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      require(
          strangers[i].flags == 0 || strangers[j].flags == 0 || strangers[i].tool_id != strangers[j].tool_id,
          "a stranger has one place");
}

}  // namespace

bool poses(Bytes input) {
  Source source(input);
  StepConfig config;
  config.tools = source.get<std::uint8_t>() % static_cast<int>(kMaxTools) + 1;
  static const auto channels = std::make_unique<server::Channels>();  // large
  for (auto& poses : channels->poses) poses.write({});
  for (auto& owner : channels->owners) owner = 0;
  channels->strangers.write({});
  const bool any = source.get<std::uint8_t>() % 2 == 0;
  server::PoseIntake intake(*channels, config, {7, any});
  dds::ToolPose pose{};
  pose.server_id = 7;
  dds::WriterId writer = 1;
  std::int64_t now_ns = 1;
  Accepted accepted{};
  bool any_accepted = false;
  while (!source.empty()) {
    const auto what = source.get<std::uint8_t>();
    if ((what & 1) != 0) writer = source.get<std::uint8_t>() % 4 + 1U;
    if ((what & 2) != 0) now_ns += std::int64_t{source.get<std::uint8_t>()} * 1'000'000;
    if ((what & 4) != 0) {
      intake.left(writer);
      continue;
    }
    pose = poseAfter(pose, source);
    const bool ours = pose.server_id == 7 || (any && pose.server_id == dds::kServerAny);
    const bool admitted = intake.admits(pose);
    require(!admitted || ours, "poses for others are left to them");
    require(admitted || !ours || pose.tool_id >= kMaxTools, "poses of known tools come in");
    if (!admitted) continue;
    intake.accept(pose, writer, now_ns);
    any_accepted = true;
    if (pose.tool_id < static_cast<std::uint32_t>(config.tools)) ++accepted[pose.tool_id];
    if (const auto delay = server::delayOf(pose.stamp_ns, now_ns)) require(*delay >= 0, "a delay is one");
  }
  look(*channels, accepted);
  return any_accepted;
}

}  // namespace palpate::fuzz
