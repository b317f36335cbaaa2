// SPDX-License-Identifier: Apache-2.0
#include "palpate/rt/process_threads.h"

#include <sched.h>
#include <sys/types.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <system_error>

namespace palpate::rt {
namespace {

std::vector<int> cpusOf(pid_t thread) {
  cpu_set_t set;
  std::vector<int> cpus;
  if (sched_getaffinity(thread, sizeof set, &set) != 0) return cpus;
  for (int cpu = 0; cpu < CPU_SETSIZE; ++cpu)
    if (CPU_ISSET(cpu, &set)) cpus.push_back(cpu);
  return cpus;
}

}  // namespace

std::vector<ThreadFacts> threadsOfThisProcess() {
  std::vector<ThreadFacts> threads;
  std::error_code gone;
  for (const auto& task : std::filesystem::directory_iterator("/proc/self/task", gone)) {
    ThreadFacts thread;
    thread.id = std::atoi(task.path().filename().c_str());
    sched_param parameters{};
    if (!std::getline(std::ifstream(task.path() / "comm"), thread.name)) continue;
    if (sched_getscheduler(thread.id) == SCHED_FIFO && sched_getparam(thread.id, &parameters) == 0)
      thread.fifo_priority = parameters.sched_priority;
    thread.cpus = cpusOf(thread.id);
    threads.push_back(std::move(thread));
  }
  std::sort(threads.begin(), threads.end(),
            [](const ThreadFacts& a, const ThreadFacts& b) { return a.id < b.id; });
  return threads;
}

std::vector<int> usableCpus() {
  return cpusOf(0);
}

int useCpus(std::span<const int> cpus) noexcept {
  cpu_set_t set;
  CPU_ZERO(&set);
  for (const int cpu : cpus)
    if (cpu >= 0 && cpu < CPU_SETSIZE) CPU_SET(cpu, &set);
  return sched_setaffinity(0, sizeof set, &set) == 0 ? 0 : errno;
}

std::string cpuList(std::span<const int> cpus) {
  std::string list;
  for (std::size_t i = 0; i < cpus.size(); ++i) {
    const std::size_t first = i;
    while (i + 1 < cpus.size() && cpus[i + 1] == cpus[i] + 1) ++i;
    if (!list.empty()) list += ',';
    list += std::to_string(cpus[first]);
    if (i > first) list.append("-").append(std::to_string(cpus[i]));
  }
  return list;
}

}  // namespace palpate::rt
