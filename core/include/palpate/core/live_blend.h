// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "palpate/core/live_parameters.h"

namespace palpate {

/// The live parameters on their way to where they were told to go: linear in time, K_vc by its inverse, from what is
/// in force at the moment of the change. On the way too the damping is at most kLongestCouplingTime K_vc.
/// Infinity means off as in StepConfig, and there are no numbers between it and others: such a change takes place at
/// once, and jumped() says so, so that the force is blended over instead. But friction that was infinite goes on from 2,
/// and a force limit from the largest force there is: no force is ever longer than the limit. A rate limit that rises lets go of a force
/// that lags behind: a jump as well.
class LiveBlend {
 public:
  static constexpr double kSeconds = 0.1;  ///< that a change takes

  /// @param model_modulus  E of the model, Pa, that youngs_modulus = 0 means
  LiveBlend(const LiveParameters& parameters, double model_modulus) noexcept;

  /// One tick of dt seconds; `target` may be a new one in each. @param largest_force  that is rendered to a tool, N.
  /// Real-time: yes.
  void advance(const LiveParameters& target, double dt, double largest_force) noexcept PALPATE_NONBLOCKING;
  /// True when the last advance() made a change that a force does not follow continuously.
  [[nodiscard]] bool jumped() const noexcept { return jumped_; }
  /// What is in force; youngs_modulus is never 0.
  [[nodiscard]] const LiveParameters& now() const noexcept { return now_; }
  /// Where it goes to.
  [[nodiscard]] const LiveParameters& target() const noexcept { return target_; }
  /// True while on the way.
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
