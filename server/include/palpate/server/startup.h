// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <string>
#include <string_view>
#include <vector>

#include "palpate/idl/receive_threads.h"
#include "palpate/rt/memory.h"
#include "palpate/rt/process_threads.h"
#include "palpate/rt/scheduling.h"

namespace palpate::server {

// docs/design.md, Threads.
inline constexpr int kTickPriority = 80;
inline constexpr int kForcePriority = 75;
inline constexpr int kReceivePriority = 70;
inline constexpr int kSurfacePriority = 40;

/// Real-time threads sleep each period. One that does not for so long is broken: docs/design.md, Threads.
inline constexpr std::chrono::milliseconds kLongestComputation{500}, kLastComputation{5000};

using dds::kReceiveThreads;

// How to get what a system does not grant.
inline constexpr const char* kPriorityRemedy =
    "rtprio 90 in /etc/security/limits.d (palpate-limits.conf), LimitRTPRIO=90 in a unit "
    "(palpate-server.service), or "
    "CAP_SYS_NICE";
inline constexpr const char* kMemoryRemedy =
    "memlock unlimited in /etc/security/limits.d (palpate-limits.conf), LimitMEMLOCK=infinity in a unit "
    "(palpate-server.service), or CAP_IPC_LOCK";
inline constexpr const char* kAwakeRemedy =
    "write access to /dev/cpu_dma_latency (palpate-cpu-latency.rules), in a unit also "
    "DeviceAllow=/dev/cpu_dma_latency rw";

/// What the system granted, once all threads run.
struct Startup {
  rt::RealtimePolicy policy{rt::RealtimePolicy::kPrefer};
  rt::MemoryLock memory;
  bool model_locked{false};
  bool awake{false};  ///< /dev/cpu_dma_latency is held at 0
  std::vector<rt::ThreadFacts> threads;
};

/// SCHED_FIFO priority that a thread is to have, by its name; 0: none.
[[nodiscard]] int wantedPriority(std::string_view thread) noexcept;

/// What was wanted and what was obtained, one line for each thread and setting.
[[nodiscard]] std::vector<std::string> startupTable(const Startup& startup);

/// How to get what was not obtained; empty when nothing is missing.
[[nodiscard]] std::vector<std::string> remedies(const Startup& startup);

/// Keeps the whole process off the tick's CPU, but for the tick: call it before any other thread is made.
/// @throw std::runtime_error  no other CPU is left, or the system refuses
void leaveCpuToTheTick(int tick_cpu);

}  // namespace palpate::server
