// SPDX-License-Identifier: Apache-2.0
#include "palpate/server/late_watch.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <iterator>

#include "palpate/rt/clock.h"

namespace palpate::server {
namespace {

using rt::kMs;
constexpr std::int64_t kPeriod = 20 * kMs;
// Readings of the steal are this many times as far apart as one takes (many processors, long file), but at most so far.
constexpr std::int64_t kStealSpacing = 100;
constexpr std::int64_t kStealPeriod = 200 * kMs;
constexpr std::int64_t kLookPeriod = 1000 * kMs;  // a look costs milliseconds
constexpr std::int64_t kLookAgain = 100 * kMs;    // after a late tick
constexpr std::int64_t kClockStep = kMs;          // a clock that is slewed drifts by 10 us in 20 ms

// The tick's number, which it says in its first cycle.
int idOf(const rt::PeriodicThread& tick) {
  while (tick.id() == 0) rt::sleepUntil(rt::monotonicNow() + kMs);
  return tick.id();
}

std::int64_t timeOn(clockid_t clock) {
  timespec now{};
  clock_gettime(clock, &now);
  return static_cast<std::int64_t>(now.tv_sec) * 1'000'000'000 + now.tv_nsec;
}

// CLOCK_REALTIME - CLOCK_BOOTTIME, which goes on while the machine sleeps; 0 where something came in between.
std::int64_t wallAhead() {
  const std::int64_t before_ns = timeOn(CLOCK_BOOTTIME);
  const std::int64_t wall_ns = timeOn(CLOCK_REALTIME);
  return timeOn(CLOCK_BOOTTIME) - before_ns > kClockStep / 2 ? 0 : wall_ns - before_ns;
}

std::vector<std::int64_t> stolenSoFar() {
  std::ifstream file("/proc/stat");
  return rt::readSteal(std::string(std::istreambuf_iterator<char>(file), {}));
}

}  // namespace

LateWatch::LateWatch(Channels& channels, const rt::PeriodicThread& tick, int priority)
    : channels_(channels), tick_(tick), queue_(idOf(tick)), rivals_(tick.id(), priority) {}

void LateWatch::run() noexcept {
  look(rt::monotonicNow());
  bool stopping = false;
  while (!stopping) {
    (void)channels_.late_watch_ready.waitFor(kPeriod);
    stopping = channels_.stopping.load(std::memory_order_acquire);  // SYNC STOP
    const std::int64_t now_ns = rt::monotonicNow();
    sample(now_ns);
    judge(now_ns, stopping);
    namePreempted(now_ns, stopping);
    if (now_ns - looked_ns_ >= kLookPeriod) look(now_ns);
    lookAtWallClock();
  }
}

void LateWatch::sample(std::int64_t now_ns) {
  const std::int64_t slack_ns = tick_.slack();
  judge_.note(rt::QueueSample{now_ns, queue_.queued_ns(), slack_ns});
  if (now_ns < steal_due_ns_) return;
  std::vector<std::int64_t> stolen = stolenSoFar();
  const std::int64_t read_ns = rt::monotonicNow();
  judge_.note(rt::StealSample{read_ns, std::move(stolen)});
  steal_due_ns_ = read_ns + std::min(kStealPeriod, kStealSpacing * (read_ns - now_ns));
}

void LateWatch::judge(std::int64_t now_ns, bool at_once) {
  rt::LateCycle cycle;
  while (channels_.late_cycles.pop(cycle)) judge_.add(cycle);
  for (rt::LateVerdict& verdict : judge_.take(now_ns, at_once)) {
    if (verdict.cause == rt::LateCause::kPreempted)
      unnamed_.push_back(verdict);
    else
      tell(verdict, "");
  }
}

// Whoever ran for at least half of what the tick was queued, between the look before it and the one after it.
void LateWatch::namePreempted(std::int64_t now_ns, bool at_once) {
  if (unnamed_.empty() || (!at_once && now_ns - looked_ns_ < kLookAgain)) return;
  look(now_ns);
  for (const rt::LateVerdict& verdict : unnamed_) {
    const std::array<int, 2> cpus{verdict.cycle.before.cpu, verdict.cycle.ended.cpu};
    const auto rival = rivals_.mostOn(cpus, verdict.facts.queued_ns / 2);
    tell(verdict, rival ? rival->text() : "");
  }
  unnamed_.clear();
}

void LateWatch::tell(const rt::LateVerdict& verdict, const std::string& by) {
  spdlog::debug("a tick due at {} us ended {} us later: {}{}", verdict.cycle.deadline_ns / 1000,
                verdict.facts.span_ns / 1000, rt::wordOf(verdict.cause),
                by.empty() ? std::string() : " by " + by);
  LateTick tick{verdict.facts.span_ns, verdict.cycle.missed, verdict.cause, {}};
  std::copy_n(by.begin(), std::min(by.size(), tick.by.size() - 1), tick.by.begin());
  if (!channels_.late_ticks.push(tick)) channels_.unjudged.fetch_add(1, std::memory_order_relaxed);
}

void LateWatch::look(std::int64_t now_ns) {
  looked_ns_ = now_ns;
  rivals_.look();
}

void LateWatch::lookAtWallClock() {
  const std::int64_t ahead_ns = wallAhead();
  if (ahead_ns == 0) return;
  const std::int64_t step_ns = ahead_ns - wall_ahead_ns_;
  if (wall_ahead_ns_ != 0 && std::llabs(step_ns) > kClockStep) {
    channels_.clock_step_ns.store(step_ns, std::memory_order_relaxed);
    channels_.clock_steps.fetch_add(1, std::memory_order_relaxed);
  }
  wall_ahead_ns_ = ahead_ns;
}

}  // namespace palpate::server
