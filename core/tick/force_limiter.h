// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>

#include "core/base/status_flags.h"
#include "core/base/types.h"
#include "core/tick/step_config.h"

namespace palpate {

/// What a tool remembers from tick to tick about what was rendered to it.
struct Rendering {
  Vec3 target = Vec3::Zero();    ///< last good force on the tool, limited, N
  Vec3 rendered = Vec3::Zero();  ///< force of the last tick, N
  Vec3 from = Vec3::Zero();      ///< force at the last jump, N
  Vec3 mixed = Vec3::Zero();     ///< force of the last tick before its gain, N
  double blend{0.0};             ///< weight of `from`, 1 at the jump, then falling to 0
  double gain{0.0};              ///< of the last tick, 0 to 1: staleness and shutdown together
  double fade{1.0};              ///< 1, falling to 0 at shutdown
};

/// Input of the limiter in one tick.
struct LimiterInput {
  Vec3 force = Vec3::Zero();      ///< of the organ on the tool, W, N (not looked at when held)
  Mat3 stiffness = Mat3::Zero();  ///< d force / d pose, N/m (not looked at when held)
  double age{0.0};                ///< s since the last good pose
  double dt{
      0.0};  ///< s that ramps and rate advance: since the last tick, without the time that the loop stood still
  double period{0.0};       ///< s until the next force replaces this one
  double force_limit{3.3};  ///< F, N
  double force_rate_limit{std::numeric_limits<double>::infinity()};  ///< N/s
  bool held{false};           ///< no good pose in this tick: the last good force is used
  bool jumped{false};         ///< the model's force is not continuous in this tick: blend over
  bool shutting_down{false};  ///< fade to zero, for good
  bool hands_over{false};     ///< the same, from the force of the tick before, within the rate limit
};

struct LimitedForce {
  Vec3 force = Vec3::Zero();  ///< on the tool, W, N, never longer than the limit
  Mat3 stiffness =
      Mat3::Zero();  ///< d force / d pose as rendered, chain rule through all below; zero while held
  std::uint32_t flags{
      0};  ///< kForceLimited, kForceRateLimited, kStalePose, kRamping, kShuttingDown, kModelChanging
};

/// Keeps what a device gets safe and continuous (docs/design.md, Safety).
///   force = gain ((1 - blend) limit(f) + blend from),   limit(f) = f min(1, F / |f|)
///   what the gain multiplies changes no faster than the rate limit allows; release is not delayed by it, and a
///   lower force limit holds at once
///   fade  falls from 1 to 0 within ramp_time at the end; where another engine takes over, also within the rate limit
///   gain  = fade clamp((zero_after - age - period) / (zero_after - stale_timeout), 0, 1): judged by the age
///   that the force will have when the next one replaces it, so that after zero_after the force is zero
///   at any rate of the loop. Once fade falls, the gain never rises: poses that come back then are not followed, so
///   nothing would blend them in. A jump keeps the force of the tick before as `from`
///   and lets its weight fall from 1 to 0 within ramp_time. A convex mix, so that two forces that push never
///   add to one that pulls, and two within the limit never to one beyond it.
class ForceLimiter {
 public:
  explicit ForceLimiter(const StepConfig& config) noexcept : config_(config) {}

  /// Real-time: yes.
  [[nodiscard]] LimitedForce limit(const LimiterInput& in,
                                   Rendering& memory) const noexcept PALPATE_NONBLOCKING;

 private:
  [[nodiscard]] double freshness(double age_at_end) const noexcept PALPATE_NONBLOCKING;

  StepConfig config_;
};

}  // namespace palpate
