// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <memory>

#include "palpate/rt/thread.h"
#include "palpate/rt/thread_reading.h"

namespace palpate::rt {

/// What a cycle is told about its own timing.
struct Cycle {
  std::uint64_t index{0};       ///< cycles run before this one
  std::int64_t deadline_ns{0};  ///< when it was due, CLOCK_MONOTONIC
  std::int64_t woke_ns{0};      ///< when it began, not before that
  std::int64_t previous_ns{0};  ///< how long the cycle before computed; 0 in the first
  std::uint64_t overruns{0};    ///< periods missed since the start
};

/// A late cycle: it woke more than half a period after it was due, or ended after the next one was due, or the machine slept
/// meanwhile; and what is known of it.
struct LateCycle {
  std::int64_t deadline_ns{0};
  std::int64_t woke_ns{0};
  std::uint64_t missed{0};     ///< periods
  ThreadReading before;        ///< at the end of the cycle before
  ThreadReading ended;         ///< at its own end
  std::int64_t queued_ns{-1};  ///< RunQueueFile at its end
  std::int64_t slack_ns{0};    ///< PeriodicThread::slack() then
};

/// Is told of each late cycle, on the periodic thread, after its end. Real-time: must be.
struct LateListener {
  void (*function)(void* context, const LateCycle& cycle) noexcept PALPATE_NONBLOCKING{nullptr};
  void* context{nullptr};
};

/// Is called shortly before each cycle, so that the processor's caches have what the cycle reads and runs. The thread wakes
/// lead_ns before the deadline, calls it and spins for the rest. Where it wakes after the deadline the cycle begins at once, and a
/// cycle after one that took longer than lead_ns is not rehearsed: it would begin late.
struct Rehearsal {
  void (*function)(void* context) noexcept PALPATE_NONBLOCKING{nullptr};
  void* context{nullptr};
  std::int64_t lead_ns{0};
};

/// How long before a deadline a rehearsal begins, ns: time for a late wake-up and for a step with cold caches, and at most an
/// eighth of the period.
[[nodiscard]] constexpr std::int64_t rehearsalLead(std::int64_t period_ns) noexcept {
  return std::min<std::int64_t>(50'000, period_ns / 8);
}

/// Sleeps until the rehearsal, or without one until the deadline, and returns at the deadline.
/// @param[in] previous_ns  how long the cycle before took
/// @return the time then, ns, on CLOCK_MONOTONIC
std::int64_t awaitDeadline(std::int64_t deadline_ns, const Rehearsal& rehearsal,
                           std::int64_t previous_ns) noexcept;

/// The next wake-up on the grid of periods, and how many were missed.
struct Deadline {
  std::int64_t ns{0};
  std::uint64_t missed{0};
};

/// Overrun policy: a period whose time has passed is counted and skipped; cycles never run in a bunch to
/// catch up, which would answer several stale times at once, and the phase of the grid is kept.
/// @param[in] last_ns    deadline of the cycle that just ended
/// @param[in] period_ns  > 0
/// @param[in] now_ns     time after the cycle
/// @param[in] shift_ns   by how much the grid moves, less than a period either way. A shift never costs a period: if it
///            would put the deadline into the past, the deadline is now and the rest of the shift is dropped
/// @return the first point of the grid after now_ns. Real-time: yes.
[[nodiscard]] Deadline nextDeadline(std::int64_t last_ns, std::int64_t period_ns, std::int64_t now_ns,
                                    std::int64_t shift_ns = 0) noexcept PALPATE_NONBLOCKING;

/// Calls a function once a period, paced by absolute sleeps on CLOCK_MONOTONIC.
/// Threads: the function runs on the thread; the other members belong to the creator.
class PeriodicThread {
 public:
  /// A plain pointer and context: its call is visible and cannot allocate. A compiler that knows the effect refuses a
  /// function that may block.
  /// @return shift of the grid, less than a period either way, ns; 0 keeps it where it is
  using Function = std::int64_t (*)(void* context, const Cycle& cycle) noexcept PALPATE_NONBLOCKING;

  /// Starts at once.
  /// @param[in] period_ns  > 0
  /// @param[in] late       with a function, each cycle ends with a ThreadReading
  /// @param[in] rehearsal  without a function, the thread sleeps until each deadline
  /// @throw RealtimeError  as Thread; @throw std::invalid_argument  period_ns <= 0
  PeriodicThread(const ThreadOptions& options, std::int64_t period_ns, Function function, void* context,
                 const LateListener& late = {}, const Rehearsal& rehearsal = {});
  ~PeriodicThread() { stop(); }
  PeriodicThread(const PeriodicThread&) = delete;
  PeriodicThread& operator=(const PeriodicThread&) = delete;

  /// Lets the running cycle end, then joins. At most one period.
  void stop();
  /// The same where that takes no longer than `patience`. @return whether it did; if not, the destructor waits for it
  [[nodiscard]] bool joinWithin(std::chrono::milliseconds patience);

  [[nodiscard]] bool realtime() const noexcept { return thread_->realtime(); }

  /// The kernel's number of the thread; 0 until its first cycle. Threads: any.
  [[nodiscard]] int id() const noexcept { return id_.load(std::memory_order_relaxed); }

  /// Cycles that ended so far. Threads: any.
  [[nodiscard]] std::uint64_t cycles() const noexcept { return cycles_.load(std::memory_order_relaxed); }

  /// Time that cycles which were not late did not run, from when the thread had to wake until they ended, ns, so far; 0 without
  /// a LateListener. No more of what the thread has queued belongs to them. Threads: any.
  [[nodiscard]] std::int64_t slack() const noexcept { return slack_ns_.load(std::memory_order_relaxed); }

  /// Page faults of the thread from the end of its tenth cycle to the end of its last one. Valid after stop().
  [[nodiscard]] std::int64_t pageFaults() const noexcept { return page_faults_; }

 private:
  class LateWatch;
  void run(std::int64_t period_ns, Function function, void* context, const LateListener& late,
           const Rehearsal& rehearsal) noexcept;

  std::atomic<bool> stopping_{false};  // a flag only, orders nothing: join() in stop() does
  std::atomic<int> id_{0};             // relaxed, as the next two: they order nothing
  std::atomic<std::int64_t> slack_ns_{0};
  std::atomic<std::uint64_t> cycles_{0};
  std::int64_t page_faults_{0};  // written by the thread, read after join()
  std::unique_ptr<Thread> thread_;
};

}  // namespace palpate::rt
