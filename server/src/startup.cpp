// SPDX-License-Identifier: Apache-2.0
#include "palpate/server/startup.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstring>
#include <stdexcept>

namespace palpate::server {
namespace {

std::string row(const std::string& what, const std::string& wanted, const std::string& got,
                const std::string& where) {
  std::array<char, 256> text{};
  std::snprintf(text.data(), text.size(), "%-16s %-12s %-30s %s", what.c_str(), wanted.c_str(), got.c_str(),
                where.c_str());
  std::string line = text.data();
  line.erase(line.find_last_not_of(' ') + 1);
  return line;
}

std::string priorityText(int priority) {
  return priority > 0 ? "FIFO " + std::to_string(priority) : "other";
}

// What is wanted under this policy.
int wanted(const Startup& startup, const rt::ThreadFacts& thread) {
  return startup.policy == rt::RealtimePolicy::kOff ? 0 : wantedPriority(thread.name);
}

std::string memoryText(const Startup& startup) {
  if (!startup.memory.present) return std::string("refused: ") + std::strerror(startup.memory.refused);
  if (!startup.memory.future) return "what exists by now";
  return startup.model_locked ? "all, and what comes" : "all but the model";
}

bool isNamedReceiver(std::string_view name) {
  return std::find(std::begin(kReceiveThreads), std::end(kReceiveThreads), name) != std::end(kReceiveThreads);
}

}  // namespace

int wantedPriority(std::string_view thread) noexcept {
  if (thread == "tick") return kTickPriority;
  if (thread == "force-out") return kForcePriority;
  if (thread == "surface-out") return kSurfacePriority;
  return isNamedReceiver(thread) ? kReceivePriority : 0;
}

std::vector<std::string> startupTable(const Startup& startup) {
  std::vector<std::string> lines{row("thread", "wanted", "got", "CPUs")};
  std::size_t receiving = 0;
  for (const rt::ThreadFacts& thread : startup.threads) {
    lines.push_back(row(thread.name, priorityText(wanted(startup, thread)),
                        priorityText(thread.fifo_priority), rt::cpuList(thread.cpus)));
    receiving += isNamedReceiver(thread.name) && thread.fifo_priority == kReceivePriority ? 1 : 0;
  }
  const bool asked = startup.policy != rt::RealtimePolicy::kOff;
  lines.push_back(
      row("DDS receive", asked ? "raised" : "as it is", std::to_string(receiving) + " raised", ""));
  lines.push_back(row("memory locked", "all", memoryText(startup), ""));
  lines.push_back(row("prefaulted", "all", startup.memory.present ? "all, and stacks" : "stacks", ""));
  lines.push_back(
      row("cpu_dma_latency", asked ? "0 us" : "as it is", startup.awake ? "0 us" : "not held", ""));
  return lines;
}

std::vector<std::string> remedies(const Startup& startup) {
  std::vector<std::string> lines;
  const bool asked = startup.policy != rt::RealtimePolicy::kOff;
  const bool raised = std::all_of(
      startup.threads.begin(), startup.threads.end(),
      [&](const rt::ThreadFacts& thread) { return thread.fifo_priority >= wanted(startup, thread); });
  if (!raised) lines.push_back(std::string("for priorities: ") + kPriorityRemedy);
  if (!startup.memory.present || !startup.memory.future || !startup.model_locked)
    lines.push_back(std::string("for locked memory: ") + kMemoryRemedy);
  if (asked && !startup.awake) lines.push_back(std::string("for short wake-ups: ") + kAwakeRemedy);
  return lines;
}

void leaveCpuToTheTick(int tick_cpu) {
  std::vector<int> cpus = rt::usableCpus();
  cpus.erase(std::remove(cpus.begin(), cpus.end(), tick_cpu), cpus.end());
  if (cpus.empty())
    throw std::runtime_error("tick_cpu_alone: no CPU is left for the other threads but " +
                             std::to_string(tick_cpu));
  if (const int error = rt::useCpus(cpus); error != 0)
    throw std::runtime_error("tick_cpu_alone: CPUs " + rt::cpuList(cpus) +
                             " refused: " + std::strerror(error));
}

}  // namespace palpate::server
