// SPDX-License-Identifier: Apache-2.0
#include "tools/examine/bench/quiet_core.h"

#include <sched.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <stdexcept>

#include "tools/program/exit_code.h"

namespace palpate::bench {

int pinTo(int cpu) {
  cpu_set_t set;
  CPU_ZERO(&set);
  if (cpu < 0) {
    if (sched_getaffinity(0, sizeof set, &set) != 0)
      throw std::runtime_error(std::string("which processors may be used: ") + std::strerror(errno));
    for (int c = 0; c < CPU_SETSIZE; ++c)
      if (CPU_ISSET(c, &set)) cpu = c;
    CPU_ZERO(&set);
  }
  if (cpu >= CPU_SETSIZE)
    throw program::UsageError("--cpu is " + std::to_string(cpu) + ", expected at most " +
                              std::to_string(CPU_SETSIZE - 1));
  CPU_SET(cpu, &set);
  if (sched_setaffinity(0, sizeof set, &set) != 0)
    throw program::UsageError("--cpu is " + std::to_string(cpu) + ", where this process may not run (" +
                              std::strerror(errno) + ")");
  return cpu;
}

void raiseLikeTheTick() {
  constexpr int kTickPriority = 80;  // docs/design.md, Threads
  sched_param parameters{};
  parameters.sched_priority = kTickPriority;
  if (sched_setscheduler(0, SCHED_FIFO, &parameters) != 0)
    throw std::runtime_error(std::string("--realtime: SCHED_FIFO 80 is not granted (") +
                             std::strerror(errno) + "); run as root or raise ulimit -r to 80");
}

std::vector<std::string> disturbances(int cpu) {
  constexpr double kQuiet = 0.5;  // processes that ran or waited in the last minute
  std::vector<std::string> found;
  double load = 0.0;
  if (std::ifstream("/proc/loadavg") >> load && load > kQuiet)
    found.push_back("the machine has other work: load " + std::to_string(load).substr(0, 4) + " on " +
                    std::to_string(sysconf(_SC_NPROCESSORS_ONLN)) + " processors in the last minute");
  const std::string path = "/sys/devices/system/cpu/cpu" + std::to_string(cpu) + "/cpufreq/scaling_governor";
  std::string governor;
  if (std::ifstream(path) >> governor && governor != "performance")
    found.push_back("processor " + std::to_string(cpu) + " has the governor " + governor +
                    ", its clock may change: echo performance > " + path);
  return found;
}

}  // namespace palpate::bench
