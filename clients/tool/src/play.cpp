// SPDX-License-Identifier: Apache-2.0
#include "play.h"

#include <chrono>
#include <iostream>
#include <thread>

#include "answer_log.h"
#include "palpate/client/error.h"
#include "palpate/client/sending.h"
#include "palpate/client/stop_signal.h"
#include "palpate/rt/clock.h"
#include "palpate/rt/pacer.h"

namespace palpate::tool {
namespace {

using namespace std::chrono_literals;

constexpr std::int64_t kPeriodNs = 1'000'000;

struct SentPose {
  std::uint64_t seq;
  double t_s;
  device::Point position;
};

std::vector<Sample> join(const std::vector<SentPose>& sent, const std::vector<AnswerLog::Answer>& answers) {
  std::vector<Sample> samples;
  auto pose = sent.begin();
  for (const AnswerLog::Answer& answer : answers) {
    while (pose != sent.end() && pose->seq < answer.force.pose_seq) ++pose;
    if (pose != sent.end() && pose->seq == answer.force.pose_seq)
      samples.push_back({pose->t_s, pose->position, answer.force});
  }
  return samples;
}

void sendAlong(const device::Path& path, client::ToolClient& tool, const AnswerLog& log,
               std::vector<SentPose>& sent, Recording& recording) {
  const std::int64_t start_ns = rt::monotonicNow();
  rt::Pacer pacer(kPeriodNs);
  for (double t = 0.0; t <= path.seconds() && !client::stopRequested(); pacer.wait()) {
    if (log.server_left.load(std::memory_order_relaxed)) break;
    t = static_cast<double>(rt::monotonicNow() - start_ns) * 1e-9;
    const device::Point position = path.at(t);
    const std::uint64_t seq = tool.publish(position);
    if (seq > 0) sent.push_back({seq, t, position});
  }
  recording.missed_periods = pacer.missed();
}

}  // namespace

Recording play(const dds::Participant& participant, std::uint32_t tool_id, const device::Path& path,
               const client::ServerRun& server) {
  Recording recording;
  const auto capacity = static_cast<std::size_t>(path.seconds() * 1e3) + 1000;
  AnswerLog log(capacity);
  std::vector<SentPose> sent;
  sent.reserve(capacity);
  {
    const client::StatusBoard statuses(participant);
    client::ToolClient tool(participant, tool_id, &AnswerLog::onForce, &log, server);
    {
      const client::SendingPriority priority(tool);
      if (!priority.granted()) std::cerr << client::kNotRealtime;
      sendAlong(path, tool, log, sent, recording);
    }
    std::this_thread::sleep_for(20ms);  // the last answers are on their way
    recording.left_out = tool.hold().leftOut();
    recording.left_out_text = client::leftOutText(recording.left_out, statuses);
    recording.model_changes = tool.modelChanges();
  }
  recording.samples = join(sent, log.first_answers);
  recording.answers = log.answers;
  recording.sent = sent.size();
  recording.server_left = log.server_left;
  if (recording.samples.empty())
    throw client::ClientError("no force came back for " + std::to_string(sent.size()) + " poses");
  return recording;
}

}  // namespace palpate::tool
