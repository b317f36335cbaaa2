// SPDX-License-Identifier: Apache-2.0
// What the events thread notes of times: delays of threads, late ticks, steps of the wall clock.
#include "event_kinds.h"
#include "palpate/server/events.h"

namespace palpate::server {

// Where a pose's delay can be told: the owner of its tool runs here.
void Events::noteOwners() {
  if (processes_ == nullptr) return;
  for (std::size_t tool = 0; tool < owners_.size(); ++tool) {
    const std::uint64_t owner = channels_.owners[tool].load(std::memory_order_relaxed);
    if (owner == owners_[tool]) continue;
    owners_[tool] = owner;
    const std::string host = processes_->processOf(poses_, owner).host;
    channels_.owner_is_here[tool].store(host == status_.facts().host, std::memory_order_relaxed);
  }
}

void Events::noteDelays(std::int64_t now_ns) {
  for (Times* times : {&health_.tick, &health_.wakeup, &health_.receive, &health_.force_out})
    times->recent.goOn(now_ns);
  std::int64_t delay_ns = 0;
  while (channels_.receive_delays.pop(delay_ns)) health_.receive.add(delay_ns);
  while (channels_.force_delays.pop(delay_ns)) health_.force_out.add(delay_ns);
}

// Every late tick counts; of those that missed a period one a second is told.
void Events::noteLateTicks(std::int64_t now_ns) {
  const std::uint64_t unjudged = channels_.unjudged.load(std::memory_order_relaxed);
  health_.late[static_cast<std::size_t>(rt::LateCause::kUnknown)] += unjudged - unjudged_;
  unjudged_ = unjudged;
  LateTick tick;
  while (channels_.late_ticks.pop(tick)) {
    ++health_.late[static_cast<std::size_t>(tick.cause)];
    const std::string by = tick.by.data();
    if (!by.empty()) health_.preempted_by = by;
    if (tick.missed > 0)
      warn(kLateKind,
           "a tick ended " + std::to_string(tick.late_ns / 1000) + " us after it was due: " +
               (tick.cause == rt::LateCause::kUnknown ? "cause unknown" : rt::wordOf(tick.cause)) +
               (by.empty() ? "" : " by " + by),
           now_ns);
  }
}

void Events::noteClockSteps(std::int64_t now_ns) {
  const std::uint64_t steps = channels_.clock_steps.load(std::memory_order_relaxed);
  if (steps == health_.clock_steps) return;
  health_.clock_steps = steps;
  health_.clock_step_ns = channels_.clock_step_ns.load(std::memory_order_relaxed);
  warn(kClockStepKind,
       "the machine's wall clock was set by " +
           std::to_string(1e-9 * static_cast<double>(health_.clock_step_ns)) +
           " s: no tick depends on it, stamps taken from it jump",
       now_ns);
}

}  // namespace palpate::server
