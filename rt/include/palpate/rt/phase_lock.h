// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace palpate::rt {

/// What a PhaseLock does with its stream.
enum class PhaseState : std::uint32_t {
  kFree = 1,  ///< nothing is followed: no stream, too short a one, or one without a phase of its own
  kSeeking,   ///< the grid is on its way
  kLocked,    ///< values come the margin before the deadline
  kWaiting,   ///< the stream could not be followed: free, until it is tried again
};

/// What came since the last deadline.
struct Arrivals {
  std::uint64_t count{0};     ///< values that came; 0: none
  std::int64_t newest_ns{0};  ///< when the newest came, CLOCK_MONOTONIC; not looked at when none did
};

/// Moves the grid of a periodic thread, so that what a sender with a clock of its own sends at the same rate (or at a
/// multiple or a fraction of it) waits little for the next deadline. The period stays: a shift is at most kSlew of it,
/// and a sender whose clock is off by more than kDrift is not followed.
///
/// lead = deadline - arrival of the newest value, modulo the period. Its mean and the drift of that are tracked by a
/// critically damped second-order filter, its late side by a quantile that is stepped up by each value which comes
/// later and down by each which does not: one in 50 may miss its deadline and wait for the next. The grid moves until
/// the mean lead is that plus a guard, together at most a quarter of the period (145 us at 1 kHz): where the jitter is
/// wider, more are missed, for the wait of all would not be worth it.
///
/// A stream has a phase when it stays close to its mean; one that never does stays kFree. One that loses its phase, or
/// whose drift exceeds kDrift (also one that is sent in answer to our own ticks, which moves as we do), is given up for
/// a second, then for two, up to 32.
///
/// One lock, one stream. Of several streams each has a lock of its own, which keeps what it learnt and the waits that
/// it earned; the grid moves as one of them says, and the others see from the deadlines by how much it did.
/// Threads: one. Real-time: yes.
class PhaseLock {
 public:
  static constexpr double kSlew = 0.01;    ///< largest shift, of the period
  static constexpr double kDrift = 0.001;  ///< largest difference of the clocks that is followed

  /// @param[in] period_ns  of the grid, at least 1000
  explicit PhaseLock(std::int64_t period_ns = 1'000'000) noexcept;

  /// Call in each cycle. @param[in] deadline_ns  of this cycle
  /// @return by how much the next deadline is to move, ns; at most kSlew of the period either way
  [[nodiscard]] std::int64_t follow(std::int64_t deadline_ns,
                                    const Arrivals& arrivals) noexcept PALPATE_NONBLOCKING;

  [[nodiscard]] PhaseState state() const noexcept PALPATE_NONBLOCKING { return state_; }
  /// The stream has a phase of its own, and was not given up.
  [[nodiscard]] bool hasPhase() const noexcept PALPATE_NONBLOCKING {
    return state_ == PhaseState::kSeeking || state_ == PhaseState::kLocked;
  }
  /// How long before a deadline values are to come, in the mean: what was learnt so far, ns
  [[nodiscard]] std::int64_t margin() const noexcept PALPATE_NONBLOCKING;

 private:
  [[nodiscard]] double wrapped(double time_ns) const noexcept PALPATE_NONBLOCKING;
  void goOn(std::int64_t deadline_ns) noexcept PALPATE_NONBLOCKING;
  void observe(double lead, bool missed) noexcept PALPATE_NONBLOCKING;
  void learnLateness(double late) noexcept PALPATE_NONBLOCKING;
  void forget() noexcept PALPATE_NONBLOCKING;
  void giveUp() noexcept PALPATE_NONBLOCKING;
  void judge() noexcept PALPATE_NONBLOCKING;
  [[nodiscard]] double target() const noexcept PALPATE_NONBLOCKING;

  double period_;  // ns
  PhaseState state_{PhaseState::kFree};
  std::int64_t deadline_{0};    // of the last cycle, ns; 0: none yet
  double lead_{0.0};            // mean, as of this cycle, ns
  double drift_{0.0};           // of lead_, a period of the grid, ns
  double scatter_{0.0};         // mean distance of a lead from lead_, ns
  double lateness_;             // quantile of how much later than the mean a value comes, ns
  std::int64_t observed_{0};    // values since the stream began
  std::int64_t silent_{0};      // periods since the last one
  std::int64_t too_fast_{0};    // values in a row at which the drift was at its limit
  std::int64_t locked_for_{0};  // periods
  std::int64_t wait_{0};        // periods until the next try
  std::int64_t next_wait_;      // and after it
};

}  // namespace palpate::rt
