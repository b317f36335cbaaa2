// SPDX-License-Identifier: Apache-2.0
#include "palpate/rt/phase_lock.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace palpate::rt {
namespace {

constexpr std::int64_t kFirst = 16;               // values before a phase is believed
constexpr double kGain = 1.0 / 64.0;              // of the mean lead and its scatter, after kSettled values
constexpr std::int64_t kSettled = 64;             // values
constexpr double kDriftGain = kGain * kGain / 4;  // critically damped
constexpr double
    kClosest = 0.10,
    kFarthest =
        0.14;  // scatter below which a phase is found, and above which it is lost; values without a phase have period / 4
constexpr double kOutlier = 0.125;        // a value moves the mean by at most this, of the period
constexpr double kNear = 0.05;            // distance to the target that counts as locked, of the period
constexpr double kMissing = 0.02;         // share of the values that may come after the margin
constexpr double kStep = 4e3;             // ns, of the quantile
constexpr double kGuard = 20e3;           // ns, at most an eighth of the period
constexpr double kFirstLateness = 100e3;  // ns
constexpr double kLatest = 0.125;         // of the period
constexpr double kSilence = 50e6;         // ns without a value that end a stream; at least eight periods
constexpr double kWait = 1e9, kLongestWait = 32e9;  // ns
constexpr double kTrusted = 10e9;                   // ns locked that reset the wait to kWait

}  // namespace

PhaseLock::PhaseLock(std::int64_t period_ns) noexcept
    : period_(static_cast<double>(period_ns)),
      lateness_(std::min(kFirstLateness, kLatest * period_)),
      next_wait_(std::llround(kWait / period_)) {}

// The same phase in [-period / 2, period / 2].
double PhaseLock::wrapped(double time_ns) const noexcept PALPATE_NONBLOCKING {
  return time_ns - period_ * std::nearbyint(time_ns / period_);
}

double PhaseLock::target() const noexcept PALPATE_NONBLOCKING {
  return std::min(kGuard, period_ / 8) + lateness_;
}

std::int64_t PhaseLock::margin() const noexcept PALPATE_NONBLOCKING {
  return std::llround(target());
}

std::int64_t PhaseLock::follow(std::int64_t deadline_ns,
                               const Arrivals& arrivals) noexcept PALPATE_NONBLOCKING {
  goOn(deadline_ns);
  // A value that comes after its deadline is replaced by the next one before a cycle reads it.
  const bool missed = arrivals.count >= 2 && silent_ == 2;
  if (arrivals.count > 0) observe(static_cast<double>(deadline_ns - arrivals.newest_ns), missed);
  judge();
  if (!hasPhase()) return 0;
  const double most = kSlew * period_;
  return static_cast<std::int64_t>(std::clamp(wrapped(target() - lead_ - drift_), -most, most));
}

// The deadline shows how far the grid really moved and how many periods passed.
void PhaseLock::goOn(std::int64_t deadline_ns) noexcept PALPATE_NONBLOCKING {
  const std::int64_t last_ns = std::exchange(deadline_, deadline_ns);
  if (last_ns == 0) return;
  const auto gone = static_cast<double>(deadline_ns - last_ns);
  const std::int64_t periods = std::max<std::int64_t>(1, std::llround(gone / period_));
  lead_ = wrapped(lead_ + gone + drift_ * static_cast<double>(periods));
  silent_ += periods;
  wait_ = std::max<std::int64_t>(0, wait_ - periods);
  locked_for_ = state_ == PhaseState::kLocked ? locked_for_ + periods : 0;
}

void PhaseLock::observe(double lead, bool missed) noexcept PALPATE_NONBLOCKING {
  if (observed_++ == 0) lead_ = wrapped(lead);
  const double gain = std::max(kGain, 1.0 / static_cast<double>(observed_));
  const double off = wrapped(lead - lead_);
  scatter_ += gain * (std::abs(off) - scatter_);
  const double widest = observed_ > kSettled ? kOutlier * period_ : period_;
  const double believed = std::clamp(off, -widest, widest);
  lead_ += gain * believed;
  if (observed_ > kSettled) {
    const double most = kDrift * period_;
    drift_ += kDriftGain * believed / static_cast<double>(std::max<std::int64_t>(1, silent_));
    drift_ = std::clamp(drift_, -most, most);
    too_fast_ = std::abs(drift_) == most ? too_fast_ + 1 : 0;
  }
  if (observed_ > kFirst) learnLateness(missed ? period_ : -off);
  silent_ = 0;
}

void PhaseLock::learnLateness(double late) noexcept PALPATE_NONBLOCKING {
  const double step = std::min(kStep, kSlew * period_);
  lateness_ += step * (late > lateness_ ? 1.0 - kMissing : -kMissing);
  lateness_ = std::clamp(lateness_, 0.0, kLatest * period_);
}

void PhaseLock::forget() noexcept PALPATE_NONBLOCKING {
  observed_ = too_fast_ = 0;
  drift_ = scatter_ = 0.0;
}

void PhaseLock::giveUp() noexcept PALPATE_NONBLOCKING {
  forget();
  wait_ = next_wait_;
  next_wait_ = std::min<std::int64_t>(2 * next_wait_, std::llround(kLongestWait / period_));
}

void PhaseLock::judge() noexcept PALPATE_NONBLOCKING {
  const bool following = hasPhase();
  const bool ended = static_cast<double>(silent_) > std::max(8.0, kSilence / period_);
  if (ended) forget();
  if (following && (scatter_ > kFarthest * period_ || too_fast_ > kSettled)) giveUp();
  if (static_cast<double>(locked_for_) > kTrusted / period_) next_wait_ = std::llround(kWait / period_);
  const bool believed =
      following ? observed_ > 0 : observed_ >= kFirst && scatter_ < kClosest * period_ && too_fast_ == 0;
  if (wait_ > 0) {
    state_ = PhaseState::kWaiting;
  } else if (!believed) {
    state_ = PhaseState::kFree;
  } else {
    const double off = std::abs(wrapped(target() - lead_));
    state_ = off < kNear * period_ ? PhaseState::kLocked : PhaseState::kSeeking;
  }
}

}  // namespace palpate::rt
