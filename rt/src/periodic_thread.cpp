// SPDX-License-Identifier: Apache-2.0
#include "palpate/rt/periodic_thread.h"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <optional>
#include <stdexcept>
#include <string>

#include "palpate/rt/clock.h"

namespace palpate::rt {
namespace {

constexpr std::uint64_t kWarmUpCycles = 10;

std::int64_t pageFaultsOfThisThread() noexcept {
  rusage usage{};
  getrusage(RUSAGE_THREAD, &usage);
  return usage.ru_minflt + usage.ru_majflt;
}

}  // namespace

Deadline nextDeadline(std::int64_t last_ns, std::int64_t period_ns, std::int64_t now_ns,
                      std::int64_t shift_ns) noexcept PALPATE_NONBLOCKING {
  const std::int64_t missed = now_ns > last_ns ? (now_ns - last_ns) / period_ns : 0;
  const std::int64_t next_ns = last_ns + (missed + 1) * period_ns + shift_ns;
  return {std::max(next_ns, now_ns + 1), static_cast<std::uint64_t>(missed)};
}

std::int64_t awaitDeadline(std::int64_t deadline_ns, const Rehearsal& rehearsal,
                           std::int64_t previous_ns) noexcept {
  sleepUntil(deadline_ns - rehearsal.lead_ns);
  std::int64_t now_ns = monotonicNow();
  if (rehearsal.function != nullptr && now_ns < deadline_ns && previous_ns <= rehearsal.lead_ns)
    rehearsal.function(rehearsal.context);
  do now_ns = monotonicNow();
  while (now_ns < deadline_ns);
  return now_ns;
}

// Finds late cycles, on the periodic thread, between two cycles. One that was on time costs one reading; one that was late also a
// file of /proc and the listener.
class PeriodicThread::LateWatch {
 public:
  LateWatch(const LateListener& listener, std::int64_t period_ns, std::int64_t lead_ns,
            std::atomic<std::int64_t>& slack_ns) noexcept
      : listener_(listener),
        late_ns_(period_ns / 2),
        lead_ns_(lead_ns),
        slack_ns_(slack_ns),
        before_(readThisThread()) {}

  void ended(const Cycle& cycle, std::uint64_t missed) noexcept {
    const ThreadReading ended = readThisThread();
    const std::int64_t slept_ns = (ended.boot_ns - before_.boot_ns) - (ended.at_ns - before_.at_ns);
    if (missed > 0 || cycle.woke_ns - cycle.deadline_ns > late_ns_ || slept_ns > late_ns_) {
      listener_.function(listener_.context, {cycle.deadline_ns, cycle.woke_ns, missed, before_, ended,
                                             queue_.queued_ns(), slack_ns_.load(std::memory_order_relaxed)});
      before_ = readThisThread();  // the listener's time is nobody's
    } else {
      const std::int64_t woken_ns = std::max(cycle.deadline_ns - lead_ns_, before_.at_ns);
      const std::int64_t idle_ns = ended.at_ns - woken_ns - (ended.cpu_ns - before_.cpu_ns);
      if (idle_ns > 0)
        slack_ns_.store(slack_ns_.load(std::memory_order_relaxed) + idle_ns, std::memory_order_relaxed);
      before_ = ended;
    }
  }

 private:
  LateListener listener_;
  std::int64_t late_ns_, lead_ns_;
  std::atomic<std::int64_t>& slack_ns_;
  RunQueueFile queue_;
  ThreadReading before_;
};

PeriodicThread::PeriodicThread(const ThreadOptions& options, std::int64_t period_ns, Function function,
                               void* context, const LateListener& late, const Rehearsal& rehearsal) {
  if (period_ns <= 0) {
    throw std::invalid_argument("thread " + options.name + ": period is " + std::to_string(period_ns) +
                                " ns, expected more than 0");
  }
  thread_ =
      std::make_unique<Thread>(options, [=, this] { run(period_ns, function, context, late, rehearsal); });
}

void PeriodicThread::stop() {
  stopping_.store(true, std::memory_order_relaxed);
  thread_->join();
}

bool PeriodicThread::joinWithin(std::chrono::milliseconds patience) {
  stopping_.store(true, std::memory_order_relaxed);
  return thread_->joinWithin(patience);
}

void PeriodicThread::run(std::int64_t period_ns, Function function, void* context, const LateListener& late,
                         const Rehearsal& rehearsal) noexcept {
  id_.store(gettid(), std::memory_order_relaxed);
  std::optional<LateWatch> watch;
  if (late.function != nullptr) watch.emplace(late, period_ns, rehearsal.lead_ns, slack_ns_);
  std::int64_t faults_before = pageFaultsOfThisThread();
  Cycle cycle;
  cycle.deadline_ns = monotonicNow() + period_ns;
  while (!stopping_.load(std::memory_order_relaxed)) {
    cycle.woke_ns = awaitDeadline(cycle.deadline_ns, rehearsal, cycle.previous_ns);
    const std::int64_t shift_ns = function(context, cycle);
    const std::int64_t now_ns = monotonicNow();
    const Deadline next = nextDeadline(cycle.deadline_ns, period_ns, now_ns, shift_ns);
    if (watch) watch->ended(cycle, next.missed);
    cycle.previous_ns = now_ns - cycle.woke_ns;
    cycle.deadline_ns = next.ns;
    cycle.overruns += next.missed;
    cycles_.store(++cycle.index, std::memory_order_relaxed);
    if (cycle.index == kWarmUpCycles) faults_before = pageFaultsOfThisThread();
  }
  page_faults_ = pageFaultsOfThisThread() - faults_before;
}

}  // namespace palpate::rt
