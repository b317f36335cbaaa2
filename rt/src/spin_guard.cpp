// SPDX-License-Identifier: Apache-2.0
#include "palpate/rt/spin_guard.h"

#include <sched.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <string>
#include <thread>

namespace palpate::rt {
namespace {

/// What a thread has done so far.
struct Progress {
  std::int64_t computed_ns{0};  ///< on a processor
  std::string slept;            ///< how often it gave up the processor by itself, as the kernel writes it
};

Progress progressOf(int id) {
  const std::string task = "/proc/self/task/" + std::to_string(id);
  Progress progress;
  std::ifstream(task + "/schedstat") >> progress.computed_ns;
  std::ifstream status(task + "/status");
  for (std::string line; std::getline(status, line);)
    if (line.starts_with("voluntary_ctxt_switches:")) progress.slept = line;
  return progress;
}

}  // namespace

int limitRealtimeWithoutSleep(std::chrono::milliseconds longest, std::chrono::milliseconds last) noexcept {
  rlimit limit{};
  if (getrlimit(RLIMIT_RTTIME, &limit) != 0) return errno;
  const auto us = [](std::chrono::milliseconds time) { return static_cast<rlim_t>(time.count()) * 1000; };
  limit.rlim_max = std::min(limit.rlim_max, us(last));  // may be lowered only
  limit.rlim_cur = std::min(limit.rlim_max, us(longest));
  return setrlimit(RLIMIT_RTTIME, &limit) == 0 ? 0 : errno;
}

std::vector<ThreadFacts> spinningThreads(std::chrono::milliseconds time) {
  std::vector<ThreadFacts> threads = threadsOfThisProcess();
  std::erase_if(threads, [](const ThreadFacts& thread) { return thread.fifo_priority == 0; });
  std::vector<Progress> before;
  for (const ThreadFacts& thread : threads) before.push_back(progressOf(thread.id));
  std::this_thread::sleep_for(time);
  std::vector<ThreadFacts> spinning;
  for (std::size_t i = 0; i < threads.size(); ++i) {
    const Progress now = progressOf(threads[i].id);
    const std::int64_t most_ns = std::chrono::nanoseconds(time).count() / 2;
    if (now.slept == before[i].slept && now.computed_ns - before[i].computed_ns > most_ns)
      spinning.push_back(threads[i]);
  }
  return spinning;
}

int lowerThread(const ThreadFacts& thread) {
  std::ofstream("/proc/self/task/" + std::to_string(thread.id) + "/comm")
      << thread.name.substr(0, 11) + "-low";
  const sched_param ordinary{};
  return sched_setscheduler(thread.id, SCHED_OTHER, &ordinary) == 0 ? 0 : errno;
}

}  // namespace palpate::rt
