// SPDX-License-Identifier: Apache-2.0
#include "palpate/client/tool_client.h"

#include <algorithm>

#include "core/devices/path/in_range.h"
#include "palpate/client/error.h"
#include "palpate/rt/clock.h"

namespace palpate::client {
namespace {

constexpr std::uint32_t kTools = 4;  // palpate.idl: tool_id 0 .. 3

std::uint32_t checkedId(std::uint32_t tool_id) {
  device::inRange<ClientError>("tool id", tool_id, 0, kTools - 1);
  return tool_id;
}

}  // namespace

ToolClient::ToolClient(const dds::Participant& participant, std::uint32_t tool_id, ForceCallback callback,
                       void* context, const ServerRun& wanted)
    : tool_id_(checkedId(tool_id)),
      first_seq_(static_cast<std::uint64_t>(rt::monotonicNow())),
      last_seq_(first_seq_ - 1),
      callback_(callback),
      context_(context),
      hold_(wanted),
      poses_(participant),
      forces_(participant, &ToolClient::onForce, this) {
  pose_.tool_id = tool_id_;
  pose_.seq = first_seq_ - 1;
}

std::uint64_t ToolClient::publish(const device::Point& position, const std::array<double, 4>& orientation,
                                  std::uint32_t buttons) noexcept {
  ++pose_.seq;
  std::copy(position.begin(), position.end(), pose_.position);
  std::copy(orientation.begin(), orientation.end(), pose_.orientation);
  pose_.buttons = buttons;
  pose_.stamp_ns = rt::monotonicNow();
  pose_.server_id = hold_.address(pose_.stamp_ns);
  last_seq_.store(pose_.seq,
                  std::memory_order_relaxed);  // before the pose is out, so that its answer is known
  return poses_.write(pose_) ? pose_.seq : 0;
}

bool ToolClient::answersUs(const dds::ToolForce& force) const noexcept {
  return force.pose_seq >= first_seq_ && force.pose_seq <= last_seq_.load(std::memory_order_relaxed);
}

std::string ToolClient::mismatch() const {
  const std::string poses = poses_.mismatch();
  return poses.empty() ? forces_.mismatch() : poses;
}

bool ToolClient::waitForServer(std::chrono::milliseconds timeout) const noexcept {
  const auto deadline = std::chrono::steady_clock::now() + timeout;
  if (!poses_.waitForReaders(1, timeout)) return false;
  const auto left =
      std::chrono::duration_cast<std::chrono::milliseconds>(deadline - std::chrono::steady_clock::now());
  return forces_.waitForWriters(1, std::max(left, std::chrono::milliseconds(1)));
}

void ToolClient::onForce(const dds::ToolForce& force, dds::WriterId writer, void* context) noexcept {
  auto& self = *static_cast<ToolClient*>(context);
  if (force.tool_id != self.tool_id_) return;
  const std::int64_t received_ns = rt::monotonicNow();
  const bool answers_us = self.answersUs(force);
  const bool farewell = (force.flags & dds::flag::kShuttingDown) != 0;
  const ServerRun from{force.server_id, force.session};
  if (!self.hold_.takes(from, writer, received_ns, answers_us, farewell) || !answers_us) return;
  self.models_.add(force.session, force.model_hash);
  self.latest_.write(force);
  if (self.callback_ != nullptr) self.callback_(force, received_ns, self.context_);
}

}  // namespace palpate::client
