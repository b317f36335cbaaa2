// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace palpate::rt {

/// What clocks and kernel say of one thread at one time. Counters are totals since the thread began.
struct ThreadReading {
  std::int64_t at_ns{0};    ///< CLOCK_MONOTONIC
  std::int64_t raw_ns{0};   ///< CLOCK_MONOTONIC_RAW at the same time: the counter below CLOCK_MONOTONIC
  std::int64_t boot_ns{0};  ///< CLOCK_BOOTTIME at the same time: goes on while the machine sleeps
  std::int64_t cpu_ns{
      0};  ///< CLOCK_THREAD_CPUTIME_ID; without what the host stole, where the kernel knows of it
  std::int64_t minor_faults{0};  ///< pages that had to be made or found
  std::int64_t major_faults{0};  ///< pages that had to be read from a disk
  std::int64_t waits{0};         ///< voluntary context switches: it slept, blocked or was stopped
  int cpu{0};                    ///< where it runs
};

/// Reads the calling thread. Two system calls, about 1 us in all (docs/decisions/late_ticks.md). Real-time: yes.
[[nodiscard]] ThreadReading readThisThread() noexcept PALPATE_NONBLOCKING;

/// How long a thread was ready to run and waited for a processor, as /proc/PID/task/TID/schedstat says it.
class RunQueueFile {
 public:
  /// Of the calling thread. Real-time: no.
  RunQueueFile() noexcept;
  /// Of a thread of this process. Real-time: no.
  explicit RunQueueFile(int thread_id);
  ~RunQueueFile();
  RunQueueFile(const RunQueueFile&) = delete;
  RunQueueFile& operator=(const RunQueueFile&) = delete;

  /// @return total since the thread began, ns; -1 where the kernel does not say
  /// Real-time: no, it reads a file, about 1 us. A thread that was late anyway may pay that.
  [[nodiscard]] std::int64_t queued_ns() const noexcept;

 private:
  int file_;
};

}  // namespace palpate::rt
