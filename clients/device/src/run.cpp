// SPDX-License-Identifier: Apache-2.0
#include "run.h"

#include <cmath>
#include <iostream>

#include "core/devices/path/path.h"
#include "palpate/client/error.h"
#include "palpate/client/sending.h"
#include "palpate/client/stop_signal.h"
#include "palpate/rt/pacer.h"

namespace palpate::device {
namespace {

constexpr double kPeriod = 1e-3;  // s
constexpr std::int64_t kPeriodNs = 1'000'000;
constexpr std::uint64_t kPatience = 1000;  // periods

// One exchange with the server per period.
class Exchange {
 public:
  explicit Exchange(client::ToolClient& tool) : tool_(tool), pacer_(kPeriodNs) {}

  void send(const Point& position) {
    before_ = last_sent_;
    sent_ = position;
    publish();
  }

  /// Waits for the next period, and longer until the server has answered the pose before the newest one.
  /// @return false when the run must end
  bool await(Recording& recording) {
    stalled_ = false;
    for (std::uint64_t periods = 0;; ++periods) {
      pacer_.wait();
      take(recording);
      if (recording.server_left || recording.interrupted) return false;
      if (answer_.pose_seq >= before_ && answer_.pose_seq != 0 && !letting_go_) return true;
      if (periods == kPatience) throw client::ClientError("the server has not answered for a second");
      ++recording.waited;
      stalled_ = stalled_ || letting_go_ || periods + 1 >= kStall;
      publish();
    }
  }
  /// Whether the last await() was a stall.
  [[nodiscard]] bool stalled() const { return stalled_; }
  [[nodiscard]] const dds::ToolForce& answer() const { return answer_; }

 private:
  void publish() {
    const std::uint64_t seq = tool_.publish(sent_);
    if (seq != 0) last_sent_ = seq;
  }

  void take(Recording& recording) {
    recording.interrupted = client::stopRequested();
    if (!tool_.latest(answer_)) return;
    recording.flags |= answer_.flags;
    recording.server_left = (answer_.flags & dds::flag::kShuttingDown) != 0;
    const bool stale = (answer_.flags & dds::flag::kStalePose) != 0;
    const bool ramping = (answer_.flags & dds::flag::kRamping) != 0;
    letting_go_ = stale || (letting_go_ && ramping);
    if (const auto& f = answer_.force; !std::isfinite(f[0] + f[1] + f[2]))
      throw client::ClientError("the server sent a force that is not finite");
  }

  client::ToolClient& tool_;
  rt::Pacer pacer_;
  dds::ToolForce answer_{};
  Point sent_{};
  std::uint64_t last_sent_{0};
  std::uint64_t before_{0};  // the last seq of the previous pose
  bool stalled_{false};
  bool letting_go_{false};  // a stale pose, and the ramp after it; not the ramp of a new contact
};

void note(const HeldDevice& device, const dds::ToolForce& answer, bool stalled, Recording& recording) {
  recording.trace.position.push_back(device.position());
  recording.trace.force.push_back({answer.force[0], answer.force[1], answer.force[2]});
  recording.penetration.push_back(answer.penetration);
  recording.trace.energy.push_back(device.alongForce());
  recording.trace.stalled.push_back(stalled);
  recording.work.push_back(-device.alongForce().work);
}

}  // namespace

Recording run(const dds::Participant& participant, std::uint32_t tool_id, HeldDevice& device,
              const client::ServerRun& server) {
  const client::StatusBoard statuses(participant);
  client::ToolClient tool(participant, tool_id, nullptr, nullptr, server);
  if (!client::prepareToSend(tool)) std::cerr << client::kNotRealtime;
  Recording recording;
  recording.trace.dt = kPeriod;
  Exchange exchange(tool);
  const auto count = static_cast<std::size_t>(std::lround(device.path().seconds() / kPeriod));
  note(device, {}, false, recording);
  bool goes_on = true;
  for (std::size_t i = 0; i < count && goes_on; ++i) {
    const dds::ToolForce answer = exchange.answer();  // the newest when the period begins
    exchange.send(device.position());
    device.step({answer.force[0], answer.force[1], answer.force[2]}, kPeriod);
    note(device, answer, exchange.stalled(), recording);
    goes_on = exchange.await(recording);
  }
  recording.left_out = tool.hold().leftOut();
  recording.model_changes = tool.modelChanges();
  std::cerr << client::leftOutText(recording.left_out, statuses);
  return recording;
}

}  // namespace palpate::device
