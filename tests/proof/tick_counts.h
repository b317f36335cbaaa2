// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>

namespace palpate::proof {

/// What the tick thread may call, and what it may not, by what it would wait for.
enum class Kind : std::size_t {
  kAllocation,  ///< malloc and its family, operator new with them
  kFree,        ///< free: it takes the same locks
  kLock,        ///< a mutex, read-write lock or spin lock, contended or not
  kWait,        ///< another sleep than the tick's own, a semaphore, a thread's end
  kSystemCall,  ///< files, sockets, mappings
  kKinds
};
inline constexpr std::size_t kKinds = static_cast<std::size_t>(Kind::kKinds);

/// The tick thread's page faults and context switches, as the kernel counts them.
struct Usage {
  std::int64_t minor_faults{0};
  std::int64_t major_faults{0};
  std::int64_t voluntary{0};    ///< the thread gave up its core: it slept, or waited for something
  std::int64_t involuntary{0};  ///< its core was taken away: the machine's doing
};

/// Posts of one semaphore.
struct Posts {
  std::uintptr_t semaphore{0};
  std::int64_t count{0};
};

/// What a test and the interposer in the server's process share, in memory that both map. The test writes `command`, the
/// tick thread the rest; what it wrote is valid once `state` says kDone.
struct TickCounts {
  enum Command : std::uint32_t { kNothing, kCount, kStop };
  enum State : std::uint32_t { kIdle, kCounting, kDone };

  std::atomic<std::uint32_t> command{kNothing};
  std::atomic<std::uint32_t> state{kIdle};  // SYNC DONE: stored with release, loaded with acquire
  std::int64_t sleeps{0};                   ///< of the tick, from the first that was counted to the last
  std::array<std::int64_t, kKinds> calls{};
  std::array<Posts, 4> posts{};  ///< by semaphore, in the order of their first post
  std::int64_t other_posts{0};   ///< of further semaphores
  Usage usage;                   ///< of the same ticks

  static_assert(std::atomic<std::uint32_t>::is_always_lock_free);
};

inline constexpr const char* kCountsVariable =
    "PALPATE_TICK_COUNTS";  ///< names the shared memory's file descriptor
inline constexpr const char* kMistakeVariable =
    "PALPATE_TICK_MISTAKE";  ///< malloc, lock, fault, sleep, spin, "spin surface-out" or "hang surface-out"
inline constexpr const char* kTickThread = "tick";  ///< the thread's name

}  // namespace palpate::proof
