// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "palpate/core/live_parameters.h"

namespace palpate {

/// The live parameters on their way to where they were told to go: linear in time, K_vc by its inverse, from what is
/// in force at the moment of the change. Infinity means off as in StepConfig.
class LiveBlend {
 public:
  static constexpr double kSeconds = 0.1;  ///< that a change takes

  /// @param model_modulus  E of the model, Pa, that youngs_modulus = 0 means
  LiveBlend(const LiveParameters& parameters, double model_modulus) noexcept;

  /// One tick of dt seconds; `target` may be a new one in each. Real-time: yes.
  void advance(const LiveParameters& target, double dt) noexcept PALPATE_NONBLOCKING;
  /// What is in force; youngs_modulus is never 0.
  [[nodiscard]] const LiveParameters& now() const noexcept { return now_; }
  /// Where it goes to.
  [[nodiscard]] const LiveParameters& target() const noexcept { return target_; }
  /// True while on the way.
  [[nodiscard]] bool moving() const noexcept { return left_ > 0.0; }

 private:
  [[nodiscard]] LiveParameters resolved(const LiveParameters& parameters) const noexcept;

  double model_modulus_;
  LiveParameters from_, target_, now_;
  double left_{0.0};  // s
};

}  // namespace palpate
