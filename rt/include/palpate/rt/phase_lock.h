// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace palpate::rt {

/// What a PhaseLock does with its stream.
enum class PhaseState : std::uint32_t {
  kFree = 1,  ///< follows nothing: there is no stream, it is too short, or it has no phase of its own
  kSeeking,   ///< the grid moves towards the stream's phase
  kLocked,    ///< values come the margin before the deadline
  kWaiting,   ///< the stream's phase was lost: the grid stays until the next try
};

/// What came since the last deadline.
struct Arrivals {
  std::uint64_t count{0};     ///< values that came; 0: none
  std::int64_t newest_ns{0};  ///< when the newest came, CLOCK_MONOTONIC; ignored when count is 0
};

/// Moves the grid of a periodic thread so that values wait little for the next deadline. They come from a sender with its
/// own clock, at the grid's rate or at a multiple or a fraction of it. The period stays: a shift is at most kSlew of it.
/// A sender whose clock differs by more than kDrift is not followed.
///
/// lead = deadline - arrival of the newest value, modulo the period. A critically damped second-order filter tracks the
/// mean lead and its drift. A quantile tracks lateness: a value later than the quantile steps it up, any other value
/// steps it down. One value in 50 may miss its deadline and wait for the next. The grid moves until the mean lead is the
/// quantile plus a guard, together at most a quarter of the period (145 us at 1 kHz). With wider jitter more values miss
/// their deadline; a wider margin would make all of them wait.
///
/// A stream has a phase while its values stay close to the mean lead. A stream that never has one stays kFree. A stream
/// that loses its phase, or whose drift exceeds kDrift, is ignored for 1 s, then 2 s, up to 32 s. A sender that answers
/// our own ticks drifts too, because it moves with the grid.
///
/// Each stream has its own lock, which keeps what it learnt and how long it waits. One lock moves the grid; the others
/// see its shift in the deadlines.
/// Threads: one. Real-time: yes.
class PhaseLock {
 public:
  static constexpr double kSlew = 0.01;    ///< largest shift, of the period
  static constexpr double kDrift = 0.001;  ///< largest difference of the clocks that is followed

  /// @param[in] period_ns  of the grid, at least 1000
  explicit PhaseLock(std::int64_t period_ns = 1'000'000) noexcept;

  /// Call in each cycle. @param[in] deadline_ns  of this cycle
  /// @return shift of the next deadline, ns; at most kSlew of the period either way
  [[nodiscard]] std::int64_t follow(std::int64_t deadline_ns,
                                    const Arrivals& arrivals) noexcept PALPATE_NONBLOCKING;

  [[nodiscard]] PhaseState state() const noexcept PALPATE_NONBLOCKING { return state_; }
  /// The grid follows the stream.
  [[nodiscard]] bool hasPhase() const noexcept PALPATE_NONBLOCKING {
    return state_ == PhaseState::kSeeking || state_ == PhaseState::kLocked;
  }
  /// The mean lead that the grid moves to, as learnt so far, ns
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
  double drift_{0.0};           // of lead_ per period of the grid, ns
  double scatter_{0.0};         // mean distance of a lead from lead_, ns
  double lateness_;             // quantile of the delay against the mean, ns
  std::int64_t observed_{0};    // values since the stream began
  std::int64_t silent_{0};      // periods since the last one
  std::int64_t too_fast_{0};    // values in a row with the drift at its limit
  std::int64_t locked_for_{0};  // periods
  std::int64_t wait_{0};        // periods until the next try
  std::int64_t next_wait_;      // the wait after that one, periods
};

}  // namespace palpate::rt
