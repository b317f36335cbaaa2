// SPDX-License-Identifier: Apache-2.0
#include "palpate/client/thread_priority.h"

#include <dirent.h>
#include <pthread.h>
#include <sched.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string_view>

namespace palpate::client {
namespace {

bool isReceiveThread(const char* task) noexcept {
  std::array<char, 64> path{};
  if (std::snprintf(path.data(), path.size(), "/proc/self/task/%s/comm", task) >=
      static_cast<int>(path.size()))
    return false;
  const std::unique_ptr<FILE, int (*)(FILE*)> file(std::fopen(path.data(), "re"), &std::fclose);
  std::array<char, 32> name{};
  return file != nullptr && std::fgets(name.data(), name.size(), file.get()) != nullptr &&
         std::string_view(name.data()).starts_with("recv");
}

}  // namespace

bool raiseThisThread(int priority) noexcept {
  sched_param parameters{};
  parameters.sched_priority = priority;
  return pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameters) == 0;
}

int raiseReceiveThreads(int priority) noexcept {
  DIR* tasks = opendir("/proc/self/task");
  if (tasks == nullptr) return 0;
  sched_param parameters{};
  parameters.sched_priority = priority;
  int raised = 0;
  while (const dirent* entry = readdir(tasks)) {
    if (entry->d_name[0] == '.' || !isReceiveThread(entry->d_name)) continue;
    if (sched_setscheduler(std::atoi(entry->d_name), SCHED_FIFO, &parameters) == 0) ++raised;
  }
  closedir(tasks);
  return raised;
}

}  // namespace palpate::client
