// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "palpate/core/status_flags.h"
#include "palpate/core/step_config.h"
#include "palpate/core/types.h"

namespace palpate {

/// What a tool remembers from tick to tick about what was rendered to it.
struct Rendering {
  double gain{0.0};  ///< 0 to 1; starts at 0, so that a tool that appears inside the organ is not kicked
  Vec3 target = Vec3::Zero();    ///< last good force on the tool, limited, N
  Vec3 rendered = Vec3::Zero();  ///< force of the last tick, N
  Vec3 jump = Vec3::Zero();      ///< difference being bridged, N
  double bridge{0.0};            ///< part of the jump that is left, 1 to 0
};

/// What the limiter is told in one tick.
struct LimiterInput {
  Vec3 force = Vec3::Zero();      ///< of the organ on the tool, W, N (not looked at when held)
  Mat3 stiffness = Mat3::Zero();  ///< d force / d pose, N/m
  double age{0.0};                ///< s since the last good pose
  double dt{0.0};                 ///< s since the last tick
  bool held{false};               ///< no good pose in this tick: the last good force stands in
  bool jumped{false};             ///< the force may have jumped (contact made, lost, pose back): bridge it
  bool shutting_down{false};
};

struct LimitedForce {
  Vec3 force = Vec3::Zero();      ///< on the tool, W, N, never longer than the limit
  Mat3 stiffness = Mat3::Zero();  ///< d force / d pose as rendered: limit and gain included; zero while held
  std::uint32_t flags{0};         ///< kForceLimited, kStalePose, kRamping, kShuttingDown
};

/// Keeps what a device gets safe and continuous DESIGN 3.2
///   force = gain * limit(f) + jump * bridge;  limit(f) = f min(1, F / |f|)
///   gain <= (zero_after - age) / (zero_after - stale_timeout): a stale pose ramps to zero by zero_after,
///   whatever the rate of the loop; it rises by dt / ramp_time at most. jump is taken once so that the force
///   is continuous where the model's force is not, and fades within ramp_time.
class ForceLimiter {
 public:
  explicit ForceLimiter(const StepConfig& config) noexcept : config_(config) {}

  /// Real-time: yes.
  [[nodiscard]] LimitedForce limit(const LimiterInput& in,
                                   Rendering& memory) const noexcept PALPATE_NONBLOCKING;

 private:
  [[nodiscard]] double nextGain(const LimiterInput& in, double gain) const noexcept PALPATE_NONBLOCKING;

  StepConfig config_;
};

}  // namespace palpate
