// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace palpate::rt {

/// Why a cycle was late (docs/decisions/late_ticks.md).
enum class LateCause : std::uint32_t {
  kUnknown,    ///< the kernel does not tell
  kOwnWork,    ///< the cycle computed for so long; interrupts on its processor count here too
  kPageFault,  ///< it took pages that were not in memory
  kPreempted,  ///< it was ready to run, and another thread had the processor
  kStopped,    ///< the process was stopped: SIGSTOP, a debugger, a frozen control group
  kHostSteal,  ///< the host of the virtual machine gave the processor to others
  kClockStep,  ///< the clock that cycles are paced by leapt, or the machine slept
};
inline constexpr std::size_t kLateCauses = 7;

/// What programs print and, with underscores, the keys of --json.
[[nodiscard]] const char* wordOf(LateCause cause) noexcept;

/// What is known of a late cycle, from when it was due until it ended. Times in ns.
struct LateFacts {
  std::int64_t span_ns{0};    ///< from the deadline to the end
  std::int64_t leapt_ns{0};   ///< by which CLOCK_MONOTONIC leapt ahead, or the machine slept
  std::int64_t queued_ns{0};  ///< ready to run, without a processor
  std::int64_t cpu_ns{0};     ///< running, in the cycle itself
  std::int64_t minor_faults{0};
  std::int64_t major_faults{0};
  std::int64_t extra_waits{0};  ///< voluntary switches but for that of its sleep
  bool stolen{false};           ///< the host took time of its processor then
};

/// The cause of the largest part of the span. What neither ran, nor queued, nor leapt was spent waiting for pages, stopped, or
/// without the virtual processor. CPU time counts as page faults where these, at what they cost at most, make half of it.
/// Cost: a few comparisons. Real-time: yes.
[[nodiscard]] LateCause causeOf(const LateFacts& facts) noexcept PALPATE_NONBLOCKING;

/// Most CPU time that a page fault takes while memory is short, ns: 1.4 us with memory to spare (docs/decisions/late_ticks.md).
inline constexpr std::int64_t kFaultCost = 10'000;
/// The same of a page that is read from a disk, a major fault. Mostly CPU time of the kernel and, in a virtual machine, of its
/// disk: 90 us where nothing else runs, over 200 us on a busy host.
inline constexpr std::int64_t kReadCost = 500'000;

}  // namespace palpate::rt
