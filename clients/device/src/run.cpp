// SPDX-License-Identifier: Apache-2.0
#include "run.h"

#include <cmath>
#include <iostream>
#include <optional>
#include <utility>

#include "core/devices/path/path.h"
#include "core/devices/sim/answer_line.h"
#include "palpate/client/error.h"
#include "palpate/client/letting_go.h"
#include "palpate/client/sending.h"
#include "palpate/client/stop_signal.h"
#include "palpate/rt/clock.h"
#include "palpate/rt/pacer.h"
#include "palpate/rt/spsc_queue.h"

namespace palpate::device {
namespace {

constexpr double kPeriod = 1e-3;  // s
constexpr std::int64_t kPeriodNs = 1'000'000;
constexpr std::int64_t kStallNs = static_cast<std::int64_t>(kStall) * kPeriodNs;
constexpr std::int64_t kPatienceNs = 1000 * kPeriodNs;
constexpr std::int64_t kFurthestNs = std::int64_t{1}
                                     << 60;       // 36 years: differences of stamps stay in 64 bits
constexpr std::int64_t kLookNs = kPeriodNs / 10;  // between two looks for a late answer
constexpr std::int64_t kAgainNs =
    5 * kPeriodNs;  // until a pose goes out again: far below a server's stale timeout

// Whether the server's force is another one than that of the contact: it let go, or its ticks stood still and it blends over.
class Disturbance {
 public:
  void add(const dds::ToolForce& answer) noexcept {
    const std::int64_t stamp_ns = std::clamp(answer.stamp_ns, std::int64_t{0}, kFurthestNs);
    const bool gap = last_ns_ != 0 && stamp_ns - last_ns_ > kStallNs;
    last_ns_ = stamp_ns;
    blends_ = gap || (blends_ && (answer.flags & dds::flag::kRamping) != 0);
    on_ = letting_go_.add(answer.flags) || blends_;
    came_ = came_ || on_;
  }
  [[nodiscard]] bool on() const noexcept { return on_; }
  /// Whether there was one since the last call.
  [[nodiscard]] bool came() noexcept { return std::exchange(came_, on_); }

 private:
  std::int64_t last_ns_{0};
  bool blends_{false}, on_{false}, came_{false};
  client::LettingGo letting_go_;
};

// One exchange with the server per period.
class Exchange {
 public:
  Exchange(const dds::Participant& participant, std::uint32_t tool_id, const client::ServerRun& server)
      : tool_(participant, tool_id, &onForce, &arrived_, server), pacer_(kPeriodNs) {
    if (!priority_.emplace(tool_).granted()) std::cerr << client::kNotRealtime;
    pacer_ = rt::Pacer(kPeriodNs);
  }

  /// Nothing is sent any more.
  void end() { priority_.reset(); }

  void send(std::size_t step, const Point& position) {
    position_ = position;
    if (const std::uint64_t seq = tool_.publish(position_); seq != 0) line_.sent(step, seq);
  }

  /// Waits for the next period, and longer while the answer to the pose of step `wanted` may still come or the server blends. The
  /// periods after it begin with it: where the answer needs a little more than a period, that is waited for once.
  /// @return false when the run must end
  bool await(std::optional<std::size_t> wanted, Recording& recording) {
    const std::int64_t late_ns = pacer_.wait(), begin_ns = rt::monotonicNow();
    std::int64_t now_ns = begin_ns, again_ns = begin_ns + kAgainNs;
    take(recording);
    while (!recording.server_left && !recording.interrupted &&
           (disturbance_.on() || (wanted && !line_.has(*wanted)))) {
      if (now_ns - begin_ns > kPatienceNs)
        throw client::ClientError("the server has not answered for a second");
      if (now_ns >= again_ns) {
        (void)tool_.publish(position_);
        again_ns += kAgainNs;
      }
      rt::sleepUntil(now_ns + kLookNs);
      now_ns = rt::monotonicNow();
      take(recording);
    }
    if (now_ns != begin_ns) pacer_ = rt::Pacer(kPeriodNs);
    const std::int64_t waited_ns = late_ns + now_ns - begin_ns;
    waited_ns_ += waited_ns >= kLookNs ? waited_ns : 0;
    recording.waited = static_cast<std::uint64_t>(waited_ns_ / kPeriodNs);
    const bool disturbed = disturbance_.came();
    stalled_ = disturbed || waited_ns >= kStallNs;
    return !recording.server_left && !recording.interrupted;
  }
  /// Whether the last await() was a stall.
  [[nodiscard]] bool stalled() const { return stalled_; }
  /// The answer that acts for the pose of `step`; nothing: none is known.
  [[nodiscard]] const dds::ToolForce* answer(std::size_t step) const { return line_.at(step); }
  [[nodiscard]] const client::ToolClient& tool() const { return tool_; }

 private:
  using Arrived = rt::SpscQueue<dds::ToolForce, 256>;  // from the receive thread to the run's

  static void onForce(const dds::ToolForce& force, std::int64_t, void* context) noexcept {
    (void)static_cast<Arrived*>(context)->push(force);  // full: the run stands still, and its wait is a stall
  }

  void take(Recording& recording) {
    recording.interrupted = client::stopRequested();
    for (dds::ToolForce answer{}; arrived_.pop(answer);) {
      recording.flags |= answer.flags;
      recording.server_left = recording.server_left || (answer.flags & dds::flag::kShuttingDown) != 0;
      const bool disturbed = disturbance_.on();
      disturbance_.add(answer);
      if (const auto& f = answer.force; !std::isfinite(f[0] + f[1] + f[2] + answer.penetration))
        throw client::ClientError("the server sent a force or a penetration that is not finite");
      line_.add(answer.pose_seq, answer, disturbed);
    }
  }

  Arrived arrived_;
  client::ToolClient tool_;
  std::optional<client::SendingPriority> priority_;
  rt::Pacer pacer_;
  AnswerLine<dds::ToolForce> line_;
  Disturbance disturbance_;
  Point position_{};
  std::int64_t waited_ns_{0};
  bool stalled_{false};
};

Point forceOf(const dds::ToolForce& answer) {
  return {answer.force[0], answer.force[1], answer.force[2]};
}

/// The delay of each step: a period, or as it was measured in the worst stretch that is as long as the run.
class Schedule {
 public:
  Schedule(const Delays* delays, std::size_t steps)
      : delays_(delays), first_(delays == nullptr ? 0 : delays->worstStretch(steps)) {}

  [[nodiscard]] bool sends(std::size_t step) const {
    return delays_ == nullptr || step == 0 || delays_->at(first_ + step).sends;
  }
  /// The step whose pose's answer acts; nothing: the step is before the first answer.
  [[nodiscard]] std::optional<std::size_t> answered(std::size_t step) const {
    const std::size_t lag = delays_ == nullptr ? 1 : delays_->at(first_ + step).lag;
    return lag > step ? std::nullopt : std::optional(step - lag);
  }

 private:
  const Delays* delays_;
  std::size_t first_;
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
  Exchange exchange(participant, tool_id, server);
  Recording recording;
  recording.trace.dt = kPeriod;
  const auto count = static_cast<std::size_t>(std::lround(device.path().seconds() / kPeriod));
  const Schedule schedule(delays, count);
  dds::ToolForce acts{};
  note(device, acts, false, recording);
  bool goes_on = true;
  for (std::size_t i = 0; i < count && goes_on; ++i) {
    if (const auto step = schedule.answered(i))
      if (const dds::ToolForce* answer = exchange.answer(*step)) acts = *answer;
    if (schedule.sends(i)) exchange.send(i, device.position());
    device.step(forceOf(acts), kPeriod);
    note(device, acts, exchange.stalled(), recording);
    goes_on = exchange.await(schedule.answered(i + 1), recording);
  }
  exchange.end();
  recording.left_out = exchange.tool().hold().leftOut();
  recording.model_changes = exchange.tool().modelChanges();
  std::cerr << client::leftOutText(recording.left_out, statuses);
  return recording;
}

}  // namespace palpate::device
