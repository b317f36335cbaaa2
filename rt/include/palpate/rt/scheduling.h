// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

namespace palpate::rt {

/// What to do about real-time priority (SCHED_FIFO).
enum class RealtimePolicy {
  kRequire,  ///< refuse to run without it
  kPrefer,   ///< take it when the system grants it, else run without
  kOff,      ///< do not ask
};

/// The system refuses what kRequire needs. Thrown before the loop only.
class RealtimeError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Puts the calling thread under SCHED_FIFO.
/// @param[in] priority  1 to 99
/// @return 0, or the errno of the refusal (EPERM without CAP_SYS_NICE or RLIMIT_RTPRIO)
/// Real-time: no. Threads: acts on the caller.
[[nodiscard]] int raiseThisThread(int priority) noexcept;

/// Puts the threads of this process whose name (/proc/self/task/N/comm) is one of `names` under SCHED_FIFO.
/// It reaches threads that a library made: Cyclone DDS takes no priority for its receive threads.
/// @param[in] names     exact names, as the kernel keeps them: at most 15 characters
/// @param[in] priority  1 to 99
/// @return number of threads that this call raised; a thread that had the priority before does not count
/// Real-time: no (reads /proc).
[[nodiscard]] std::size_t raiseThreadsNamed(std::span<const std::string_view> names, int priority);

/// Keeps processors out of deep sleep during its lifetime: holds /dev/cpu_dma_latency open at 0 us.
/// Halves the wake-up latency (docs/design.md, Threads), costs power.
class CpuLatencyHold {
 public:
  CpuLatencyHold() noexcept;
  ~CpuLatencyHold();
  CpuLatencyHold(const CpuLatencyHold&) = delete;
  CpuLatencyHold& operator=(const CpuLatencyHold&) = delete;

  /// false where the device is missing or this process may not open it; nothing else depends on it
  [[nodiscard]] bool held() const noexcept { return file_ >= 0; }

 private:
  int file_{-1};
};

}  // namespace palpate::rt
