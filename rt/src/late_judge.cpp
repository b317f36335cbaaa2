// SPDX-License-Identifier: Apache-2.0
#include "palpate/rt/late_judge.h"

#include <algorithm>
#include <utility>

namespace palpate::rt {
namespace {

constexpr std::size_t kMostSamples = 256;  // of each kind: 5 s at 20 ms

// Clocks that are slewed to another's rate differ by less than a thousandth, and readings by microseconds.
std::int64_t leapOf(std::int64_t ahead_ns, std::int64_t span_ns) {
  constexpr std::int64_t kReading = 50'000;  // ns
  return ahead_ns > kReading + span_ns / 1000 ? ahead_ns : 0;
}

template <class Sample>
void keep(std::deque<Sample>& samples, Sample sample) {
  samples.push_back(std::move(sample));
  if (samples.size() > kMostSamples) samples.pop_front();
}

std::int64_t stolenOn(const StealSample& sample, int cpu) {
  const auto index = static_cast<std::size_t>(cpu);
  return cpu >= 0 && index < sample.stolen.size() ? sample.stolen[index] : 0;
}

}  // namespace

void LateJudge::note(const QueueSample& sample) {
  if (sample.queued_ns >= 0) keep(queue_, sample);
}

void LateJudge::note(StealSample sample) {
  keep(steal_, std::move(sample));
}

// Before the first sample: the thread began with nothing queued.
QueueSample LateJudge::queueBefore(std::int64_t at_ns) const {
  QueueSample newest;
  for (const QueueSample& sample : queue_)
    if (sample.at_ns <= at_ns && sample.at_ns >= newest.at_ns) newest = sample;
  return newest;
}

bool LateJudge::stolenFrom(const LateCycle& cycle) const {
  const StealSample* before = nullptr;
  const StealSample* after = nullptr;
  for (const StealSample& sample : steal_) {
    if (sample.at_ns <= cycle.before.at_ns) before = &sample;
    if (after == nullptr && sample.at_ns >= cycle.ended.at_ns + kStealTold) after = &sample;
  }
  if (before == nullptr || after == nullptr) return false;
  if (cycle.before.at_ns - before->at_ns > kPatience || after->at_ns - cycle.ended.at_ns > kPatience)
    return false;
  return stolenOn(*after, cycle.before.cpu) > stolenOn(*before, cycle.before.cpu) ||
         stolenOn(*after, cycle.ended.cpu) > stolenOn(*before, cycle.ended.cpu);
}

LateFacts LateJudge::factsOf(const LateCycle& cycle) const {
  const ThreadReading &before = cycle.before, &ended = cycle.ended;
  const std::int64_t passed = ended.at_ns - before.at_ns;
  const std::int64_t slept = leapOf((ended.boot_ns - before.boot_ns) - passed, passed);
  LateFacts facts;
  facts.span_ns = ended.at_ns - cycle.deadline_ns + slept;
  facts.leapt_ns = slept + leapOf(passed - (ended.raw_ns - before.raw_ns), passed);
  // What the thread is charged for while it sleeps and wakes is not its work: interrupts, a host that tells no steal.
  facts.cpu_ns = std::min(ended.cpu_ns - before.cpu_ns, ended.at_ns - cycle.woke_ns);
  facts.minor_faults = ended.minor_faults - before.minor_faults;
  facts.major_faults = ended.major_faults - before.major_faults;
  facts.extra_waits = std::max<std::int64_t>(0, ended.waits - before.waits - 1);
  if (cycle.queued_ns >= 0) {
    // Of what was queued since that sample, cycles that were on time have at most their slack.
    const QueueSample since = queueBefore(before.at_ns);
    const std::int64_t others = std::max<std::int64_t>(0, cycle.slack_ns - since.slack_ns);
    facts.queued_ns = std::clamp<std::int64_t>(cycle.queued_ns - since.queued_ns - others, 0, facts.span_ns);
  }
  return facts;
}

void LateJudge::add(const LateCycle& cycle) {
  waiting_.push_back({cycle, factsOf(cycle), LateCause::kUnknown});
  note({cycle.ended.at_ns, cycle.queued_ns, cycle.slack_ns});
}

std::vector<LateVerdict> LateJudge::take(std::int64_t now_ns, bool at_once) {
  std::vector<LateVerdict> certain;
  std::deque<LateVerdict> later;
  for (LateVerdict& verdict : waiting_) {
    verdict.facts.stolen = stolenFrom(verdict.cycle);
    verdict.cause = causeOf(verdict.facts);
    const bool patient =  // for the first sample of the steal that tells
        verdict.cause == LateCause::kUnknown &&
        (steal_.empty() || steal_.back().at_ns < verdict.cycle.ended.at_ns + kStealTold) && !at_once &&
        now_ns < verdict.cycle.ended.at_ns + kPatience;
    (patient ? static_cast<void>(later.push_back(verdict)) : static_cast<void>(certain.push_back(verdict)));
  }
  waiting_ = std::move(later);
  return certain;
}

}  // namespace palpate::rt
