// SPDX-License-Identifier: Apache-2.0
#include "play_recording.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <memory>
#include <thread>
#include <vector>

#include "answer_log.h"
#include "palpate/client/error.h"
#include "palpate/client/sending.h"
#include "palpate/client/stop_signal.h"
#include "palpate/rt/clock.h"

namespace palpate::tool {
namespace {

using namespace std::chrono_literals;
using device::Point;

/// One tool that sends, and what it sent.
struct Sender {
  Sender(const dds::Participant& participant, std::uint32_t recorded_as, std::uint32_t sent_as,
         const client::ServerRun& server, std::size_t poses)
      : recorded(recorded_as),
        as(sent_as),
        log(poses),
        client(
            std::make_unique<client::ToolClient>(participant, sent_as, &AnswerLog::onForce, &log, server)) {
    sent.reserve(poses);
  }

  struct Sent {
    std::uint64_t seq;
    const RecordedPose* pose;
  };
  std::uint32_t recorded, as;
  AnswerLog log;
  std::vector<Sent> sent;
  std::unique_ptr<client::ToolClient> client;  // last: no answer comes once it is gone
};

using Senders = std::vector<std::unique_ptr<Sender>>;

Senders sendersOf(const dds::Participant& participant, const RecordedSession& session,
                  std::optional<std::uint32_t> as, const client::ServerRun& server) {
  Senders senders;
  for (std::uint32_t tool = 0; tool < kTools; ++tool) {
    if (!session.has[tool]) continue;
    const auto count = static_cast<std::size_t>(
        std::count_if(session.poses.begin(), session.poses.end(),
                      [tool](const RecordedPose& pose) { return pose.tool == tool; }));
    senders.push_back(std::make_unique<Sender>(participant, tool, as.value_or(tool), server, count));
  }
  return senders;
}

bool over(const Senders& senders) {
  return client::stopRequested() || std::any_of(senders.begin(), senders.end(), [](const auto& sender) {
           return sender->log.server_left.load(std::memory_order_relaxed);
         });
}

// In steps, so that a long pause can be interrupted. @return false when it ends here
bool waitUntil(std::int64_t due_ns, const Senders& senders) {
  constexpr std::int64_t kStep = 50'000'000;  // ns
  for (std::int64_t now_ns = rt::monotonicNow(); now_ns < due_ns; now_ns = rt::monotonicNow()) {
    rt::sleepUntil(std::min(due_ns, now_ns + kStep));
    if (over(senders)) return false;
  }
  return !over(senders);
}

void sendAll(const RecordedSession& session, const Senders& senders, Playback& playback) {
  std::array<Sender*, kTools> of_tool{};
  for (const auto& sender : senders) of_tool[sender->recorded] = sender.get();
  const std::int64_t start_ns = rt::monotonicNow() + 1'000'000;
  for (const RecordedPose& pose : session.poses) {
    const std::int64_t due_ns = start_ns + pose.t_ns;
    if (!waitUntil(due_ns, senders)) return;
    playback.lateness.add(rt::monotonicNow() - due_ns);
    Sender& sender = *of_tool[pose.tool];
    const std::uint64_t seq = sender.client->publish(pose.position, pose.orientation, pose.buttons);
    if (seq > 0) sender.sent.push_back({seq, &pose});
  }
}

ReplayedTool joined(const Sender& sender) {
  ReplayedTool tool;
  tool.recorded_as = sender.recorded;
  tool.sent_as = sender.as;
  tool.sent = sender.sent.size();
  tool.answers = sender.log.answers;
  StallMemory stalls;
  std::uint64_t last_seq = 0;
  auto sent = sender.sent.begin();
  for (const AnswerLog::Answer& answer : sender.log.first_answers) {
    while (sent != sender.sent.end() && sent->seq < answer.force.pose_seq) ++sent;
    if (sent == sender.sent.end() || sent->seq != answer.force.pose_seq) continue;
    const bool letting_go = sent->pose->letting_go || answer.letting_go;
    const std::uint64_t skipped = tool.poses.empty() ? 0 : sent->seq - last_seq - 1;
    last_seq = sent->seq;
    tool.poses.push_back(
        {sent->pose, answer.force, !stalls.add(letting_go, skipped, *sent->pose, answer.force)});
  }
  if (!tool.poses.empty())
    tool.superseded = tool.poses.back().now.superseded - tool.poses.front().now.superseded;
  return tool;
}

}  // namespace

bool StallMemory::add(bool letting_go, std::uint64_t skipped, const RecordedPose& recorded,
                      const dds::ToolForce& now) noexcept {
  constexpr int kForgets = 100;        // answers, 0.1 s
  constexpr int kSettles = 10;         // answers with one anchor: the ramps' and the damper's rest is over
  constexpr double kOneAnchor = 2e-6;  // m: by the stiffest device, 1000 N/m, 2 mN
  constexpr double kNoForce = 1e-3;    // N
  constexpr std::int64_t kJolt = 10'000'000;  // ns, five times the damper's smoothing
  constexpr std::int64_t kLate = 500'000;     // ns
  const double size = std::max(length(recorded.force), std::hypot(now.force[0], now.force[1], now.force[2]));
  const bool one_ramps = ((recorded.flags ^ now.flags) & dds::flag::kRamping) != 0;
  const bool slides = recorded.state == dds::tool_state::kSlide && now.state == dds::tool_state::kSlide;
  const bool quiet = !letting_go && ((recorded.flags | now.flags) & dds::flag::kRamping) == 0;
  const Point apart = Point{now.anchor[0], now.anchor[1], now.anchor[2]} - recorded.anchor;
  slid_ = slides && !letting_go && !one_ramps ? slid_ + 1 : 0;
  same_ = quiet && recorded.state == now.state && length(apart) < kOneAnchor ? same_ + 1 : 0;
  on_ = letting_go || one_ramps || (on_ && !(size < kNoForce) && slid_ < kForgets && same_ < kSettles);
  if (skipped > 1 || recorded.late || now.wakeup_ns > kLate) jolt_until_ns_ = recorded.t_ns + kJolt;
  return on_ || recorded.t_ns < jolt_until_ns_;
}

Point ReplayedPose::force() const noexcept {
  return {now.force[0], now.force[1], now.force[2]};
}

double ReplayedPose::difference() const noexcept {
  return length(force() - recorded->force);
}

double ReplayedTool::largestRecorded() const noexcept {
  double largest = 0.0;
  for (const ReplayedPose& pose : poses)
    if (pose.compared) largest = std::max(largest, length(pose.recorded->force));
  return largest;
}

double ReplayedTool::largestNow() const noexcept {
  double largest = 0.0;
  for (const ReplayedPose& pose : poses)
    if (pose.compared) largest = std::max(largest, length(pose.force()));
  return largest;
}

std::uint64_t ReplayedTool::compared() const noexcept {
  return static_cast<std::uint64_t>(
      std::count_if(poses.begin(), poses.end(), [](const ReplayedPose& pose) { return pose.compared; }));
}

const ReplayedPose* ReplayedTool::worst() const noexcept {
  const ReplayedPose* worst = nullptr;
  for (const ReplayedPose& pose : poses)
    if (pose.compared && (worst == nullptr || !(pose.difference() <= worst->difference()))) worst = &pose;
  return worst;
}

bool ReplayedTool::within(double share) const noexcept {
  const ReplayedPose* differs = worst();
  return 2 * compared() >= sent && differs != nullptr &&
         differs->difference() <= share * largestRecorded();  // false for NaN
}

Playback playRecording(const dds::Participant& participant, const RecordedSession& session,
                       std::optional<std::uint32_t> as, const client::ServerRun& server) {
  Playback playback;
  {
    const client::StatusBoard statuses(participant);
    const Senders senders = sendersOf(participant, session, as, server);
    {
      std::vector<const client::ToolClient*> tools;
      for (const auto& sender : senders) tools.push_back(&*sender->client);
      const client::SendingPriority priority(tools);
      playback.realtime = priority.granted();
      sendAll(session, senders, playback);
    }
    playback.interrupted = client::stopRequested();
    std::this_thread::sleep_for(20ms);  // the last answers are on their way
    for (const auto& sender : senders) {
      const client::LeftOut left_out = sender->client->hold().leftOut();
      playback.left_out += left_out.count;
      if (playback.left_out_text.empty()) playback.left_out_text = client::leftOutText(left_out, statuses);
      playback.model_changes = std::max(playback.model_changes, sender->client->modelChanges());
      sender->client.reset();
      playback.server_left = playback.server_left || sender->log.server_left;
      playback.tools.push_back(joined(*sender));
    }
  }
  for (const ReplayedTool& tool : playback.tools)
    if (tool.sent > 0 && tool.poses.empty())
      throw client::ClientError("no force came back for " + std::to_string(tool.sent) + " poses of tool " +
                                std::to_string(tool.sent_as));
  return playback;
}

}  // namespace palpate::tool
