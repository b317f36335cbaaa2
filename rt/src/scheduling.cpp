// SPDX-License-Identifier: Apache-2.0
#include "palpate/rt/scheduling.h"

#include <fcntl.h>
#include <pthread.h>
#include <sched.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <system_error>

namespace palpate::rt {

int raiseThisThread(int priority) noexcept {
  sched_param parameters{};
  parameters.sched_priority = priority;
  return pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameters);
}

std::size_t raiseThreadsNamed(std::span<const std::string_view> names, int priority) {
  std::size_t raised = 0;
  std::error_code gone;  // a thread may end while we walk
  for (const auto& task : std::filesystem::directory_iterator("/proc/self/task", gone)) {
    std::string comm;
    if (!std::getline(std::ifstream(task.path() / "comm"), comm)) continue;
    if (std::find(names.begin(), names.end(), comm) == names.end()) continue;
    sched_param parameters{};
    parameters.sched_priority = priority;
    const pid_t tid = std::atoi(task.path().filename().c_str());
    sched_param now{};
    if (sched_getscheduler(tid) == SCHED_FIFO && sched_getparam(tid, &now) == 0 &&
        now.sched_priority == priority)
      continue;
    if (sched_setscheduler(tid, SCHED_FIFO, &parameters) == 0) ++raised;
  }
  return raised;
}

CpuLatencyHold::CpuLatencyHold() noexcept : file_(open("/dev/cpu_dma_latency", O_WRONLY | O_CLOEXEC)) {
  const std::int32_t longest_us = 0;
  if (file_ >= 0 && write(file_, &longest_us, sizeof longest_us) != sizeof longest_us) {
    close(file_);
    file_ = -1;
  }
}

CpuLatencyHold::~CpuLatencyHold() {
  if (file_ >= 0) close(file_);
}

}  // namespace palpate::rt
