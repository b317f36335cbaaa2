// SPDX-License-Identifier: Apache-2.0
#include "run.h"

#include <array>
#include <cmath>
#include <iostream>

#include "core/devices/path/path.h"
#include "palpate/client/error.h"
#include "palpate/client/letting_go.h"
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
      if (answer_.pose_seq >= before_ && answer_.pose_seq != 0 && !letting_go_.on()) return true;
      if (periods == kPatience) throw client::ClientError("the server has not answered for a second");
      ++recording.waited;
      stalled_ = stalled_ || letting_go_.on() || periods + 1 >= kStall;
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
    (void)letting_go_.add(answer_.flags);
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
  client::LettingGo letting_go_;
};

Point forceOf(const dds::ToolForce& answer) {
  return {answer.force[0], answer.force[1], answer.force[2]};
}

/// Which answer acts, and which pose goes out, in each step.
class DelayLine {
 public:
  /// @param[in] steps  of the run: it goes through the worst stretch of so many periods
  DelayLine(const Delays* delays, std::size_t steps)
      : delays_(delays), first_(delays == nullptr ? 0 : delays->worstStretch(steps)) {}

  /// @param[in] i  step  @param[in] position  of the device  @return the pose that goes out
  [[nodiscard]] const Point& pose(std::size_t i, const Point& position) {
    if (delays_ == nullptr || i == 0 || delays_->at(first_ + i).sends) sent_ = position;
    return sent_;
  }
  /// @param[in] newest  the answer to the pose of step i - 1  @return the one that acts in step i
  [[nodiscard]] dds::ToolForce answer(std::size_t i, const dds::ToolForce& newest) {
    if (delays_ == nullptr) return newest;
    answers_[i % answers_.size()] = newest;
    const std::size_t before = delays_->at(first_ + i).lag - std::size_t{1};  // steps
    return before > i ? dds::ToolForce{} : answers_[(i - before) % answers_.size()];
  }

 private:
  const Delays* delays_;
  std::size_t first_;
  Point sent_{};
  std::array<dds::ToolForce, Delays::kStall> answers_{};  // by the step that has them as the newest
};

void note(const HeldDevice& device, const dds::ToolForce& answer, bool stalled, Recording& recording) {
  recording.trace.position.push_back(device.position());
  recording.trace.force.push_back(forceOf(answer));
  recording.penetration.push_back(answer.penetration);
  recording.trace.energy.push_back(device.alongForce());
  recording.trace.stalled.push_back(stalled);
  recording.work.push_back(-device.alongForce().work);
}

}  // namespace

Recording run(const dds::Participant& participant, std::uint32_t tool_id, HeldDevice& device,
              const client::ServerRun& server, const Delays* delays) {
  const client::StatusBoard statuses(participant);
  client::ToolClient tool(participant, tool_id, nullptr, nullptr, server);
  if (!client::prepareToSend(tool)) std::cerr << client::kNotRealtime;
  Recording recording;
  recording.trace.dt = kPeriod;
  Exchange exchange(tool);
  const auto count = static_cast<std::size_t>(std::lround(device.path().seconds() / kPeriod));
  DelayLine line(delays, count);
  note(device, {}, false, recording);
  bool goes_on = true;
  for (std::size_t i = 0; i < count && goes_on; ++i) {
    const dds::ToolForce answer =
        line.answer(i, exchange.answer());  // the newest when the period begins, or as was measured
    exchange.send(line.pose(i, device.position()));
    device.step(forceOf(answer), kPeriod);
    note(device, answer, exchange.stalled(), recording);
    goes_on = exchange.await(recording);
  }
  recording.left_out = tool.hold().leftOut();
  recording.model_changes = tool.modelChanges();
  std::cerr << client::leftOutText(recording.left_out, statuses);
  return recording;
}

}  // namespace palpate::device
