// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/live_parameters.h"

namespace palpate {

/// The live parameters on their way from the values in force to a target: linear in time, K_vc by its inverse. On the way,
/// too, the damping is at most kLongestCouplingTime K_vc.
/// Infinity means off as in StepConfig. No numbers lie between it and others, so such a change happens at once; jumped()
/// reports it, and the force is blended over instead. Two exceptions: infinite friction falls from 2, and an infinite force
/// limit from the largest force rendered, so that no force exceeds the limit. A rate limit that rises releases a force that
/// lags behind: also a jump.
class LiveBlend {
 public:
  static constexpr double kSeconds = 0.1;  ///< duration of a change

  /// @param model_modulus  E of the model, Pa, that youngs_modulus = 0 means
  LiveBlend(const LiveParameters& parameters, double model_modulus) noexcept;

  /// One tick of dt seconds; `target` may be a new one in each. @param largest_force  that is rendered to a tool, N.
  /// Real-time: yes.
  void advance(const LiveParameters& target, double dt, double largest_force) noexcept PALPATE_NONBLOCKING;
  /// True when the last advance() made a change that a force does not follow continuously.
  [[nodiscard]] bool jumped() const noexcept { return jumped_; }
  /// What is in force; youngs_modulus is never 0.
  [[nodiscard]] const LiveParameters& now() const noexcept { return now_; }
  /// The values that the change ends at.
  [[nodiscard]] const LiveParameters& target() const noexcept { return target_; }
  /// True during a change.
  [[nodiscard]] bool moving() const noexcept { return left_ > 0.0; }

 private:
  [[nodiscard]] LiveParameters resolved(const LiveParameters& parameters) const noexcept PALPATE_NONBLOCKING;
  void start(const LiveParameters& wanted, double largest_force) noexcept PALPATE_NONBLOCKING;

  double model_modulus_;
  LiveParameters from_, target_, now_;
  double left_{0.0};  // s
  bool jumped_{false};
};

}  // namespace palpate
