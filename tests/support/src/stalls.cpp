// SPDX-License-Identifier: Apache-2.0
#include "palpate/testing/stalls.h"

#include <pthread.h>

#include <algorithm>
#include <array>
#include <csignal>

#include "palpate/rt/clock.h"
#include "palpate/rt/process_threads.h"
#include "palpate/rt/scheduling.h"

namespace palpate::testing {
namespace {

constexpr std::int64_t kPeriod = 1'000'000;  // ns
constexpr std::int64_t kOrdinary = 300'000;  // ns, what a machine without other work takes to wake a thread

}  // namespace

Stalls::Stalls(std::span<const int> cpus, int priority) {
  for (std::size_t cpu = 0; cpu < cpus.size(); ++cpu)
    threads_.emplace_back([this, cpu, number = cpus[cpu], priority] { watch(cpu, number, priority); });
}

Stalls::~Stalls() {
  stopping_ = true;
  for (std::thread& thread : threads_) thread.join();
}

void Stalls::watch(std::size_t cpu, int number, int priority) {
  pthread_setname_np(pthread_self(), "stalls");
  sigset_t all;
  sigfillset(&all);
  pthread_sigmask(SIG_BLOCK, &all, nullptr);  // they are for the tests
  const std::array<int, 1> cpus{number};
  (void)rt::useCpus(cpus);
  if (priority > 0 && rt::raiseThisThread(priority) != 0) return;
  while (!stopping_) {
    const std::int64_t due_ns = rt::monotonicNow() + kPeriod;
    rt::sleepUntil(due_ns);
    const std::int64_t woke_ns = rt::monotonicNow();
    if (woke_ns - due_ns < kOrdinary) continue;
    const std::lock_guard lock(mutex_);
    late_.push_back({cpu, due_ns, woke_ns});
  }
}

double Stalls::between(std::int64_t from_ns, std::int64_t until_ns) const {
  std::vector<std::int64_t> sums(threads_.size());
  const std::lock_guard lock(mutex_);
  for (const Late& late : late_) sums[late.cpu] += within(late, from_ns, until_ns);
  return sums.empty() ? 0.0 : 1e-6 * static_cast<double>(*std::max_element(sums.begin(), sums.end()));
}

double Stalls::longest(std::int64_t from_ns, std::int64_t until_ns) const {
  std::int64_t longest = 0;
  const std::lock_guard lock(mutex_);
  for (const Late& late : late_) longest = std::max(longest, within(late, from_ns, until_ns));
  return 1e-6 * static_cast<double>(longest);
}

std::int64_t Stalls::within(const Late& late, std::int64_t from_ns, std::int64_t until_ns) {
  return std::max<std::int64_t>(0, std::min(late.woke_ns, until_ns) - std::max(late.due_ns, from_ns));
}

}  // namespace palpate::testing
