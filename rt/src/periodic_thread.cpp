// SPDX-License-Identifier: Apache-2.0
#include "palpate/rt/periodic_thread.h"

#include <sys/resource.h>

#include <algorithm>
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

PeriodicThread::PeriodicThread(const ThreadOptions& options, std::int64_t period_ns, Function function,
                               void* context) {
  if (period_ns <= 0) {
    throw std::invalid_argument("thread " + options.name + ": period is " + std::to_string(period_ns) +
                                " ns, expected more than 0");
  }
  thread_ = std::make_unique<Thread>(options, [=, this] { run(period_ns, function, context); });
}

void PeriodicThread::stop() {
  stopping_.store(true, std::memory_order_relaxed);
  thread_->join();
}

void PeriodicThread::run(std::int64_t period_ns, Function function, void* context) noexcept {
  std::int64_t faults_before = pageFaultsOfThisThread();
  Cycle cycle;
  cycle.deadline_ns = monotonicNow() + period_ns;
  while (!stopping_.load(std::memory_order_relaxed)) {
    sleepUntil(cycle.deadline_ns);
    cycle.woke_ns = monotonicNow();
    const std::int64_t shift_ns = function(context, cycle);
    const std::int64_t now_ns = monotonicNow();
    const Deadline next = nextDeadline(cycle.deadline_ns, period_ns, now_ns, shift_ns);
    cycle.previous_ns = now_ns - cycle.woke_ns;
    cycle.deadline_ns = next.ns;
    cycle.overruns += next.missed;
    if (++cycle.index == kWarmUpCycles) faults_before = pageFaultsOfThisThread();
  }
  page_faults_ = pageFaultsOfThisThread() - faults_before;
}

}  // namespace palpate::rt
