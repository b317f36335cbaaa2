// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/live_parameters.h"
#include "core/tick/coupling_choice.h"
#include "core/tick/step_config.h"

namespace palpate {

/// The live parameters on their way from the values in force to a target: linear in time, E by its logarithm, so that no tick
/// makes a soft organ much stiffer, K_vc by its inverse. Where the coupling follows the organ, it follows the E in force. On the
/// way, too, the damping is at most kLongestCouplingTime K_vc. The tip radius of settings is not looked at.
/// Infinity means off as in StepConfig. No numbers lie between it and others, so such a change happens at once; jumped()
/// reports it, and the force is blended over instead. Two exceptions: infinite friction falls from 2, and an infinite force
/// limit from the largest force rendered, so that no force exceeds the limit. A rate limit that rises releases a force that
/// lags behind: also a jump.
class LiveBlend {
 public:
  static constexpr double kSeconds = 0.1;  ///< duration of a change

  /// @param organ  its E is what youngs_modulus = 0 means
  LiveBlend(const ToolSettings& settings, const OrganStiffness& organ) noexcept;

  /// One tick of dt seconds; `target` may be a new one in each. @param largest_force  that is rendered to a tool, N.
  /// Real-time: yes.
  void advance(const ToolSettings& target, double dt, double largest_force) noexcept PALPATE_NONBLOCKING;
  /// True when the last advance() made a change that a force does not follow continuously.
  [[nodiscard]] bool jumped() const noexcept { return jumped_; }
  /// What is in force; youngs_modulus is never 0, and coupling_stiffness that of couplingCompliance(), infinity for none.
  [[nodiscard]] const LiveParameters& now() const noexcept { return now_; }
  /// tau of the damper, s: b over the softest K_vc that coupling_damping is for, so that it does not depend on the organ.
  [[nodiscard]] double dampingTime() const noexcept PALPATE_NONBLOCKING {
    return now_.coupling_damping * softest(choice_);
  }
  /// The values that the change ends at.
  [[nodiscard]] const ToolSettings& target() const noexcept { return target_; }
  /// True during a change.
  [[nodiscard]] bool moving() const noexcept { return left_ > 0.0; }

 private:
  // 1 / coupling_stiffness and 1 / rendered_stiffness, m/N: what the coupling is chosen from.
  struct Choice {
    double asked, rendered;
    [[nodiscard]] bool operator==(const Choice&) const = default;
  };
  [[nodiscard]] static double softest(const Choice& choice) noexcept PALPATE_NONBLOCKING {
    return choice.asked > choice.rendered ? choice.asked : choice.rendered;  // m/N
  }
  [[nodiscard]] static Choice choiceOf(const ToolSettings& settings) noexcept PALPATE_NONBLOCKING;
  [[nodiscard]] ToolSettings resolved(const ToolSettings& settings) const noexcept PALPATE_NONBLOCKING;
  [[nodiscard]] double couplingOf(const Choice& choice, double E) const noexcept PALPATE_NONBLOCKING;
  void start(const ToolSettings& wanted, double largest_force) noexcept PALPATE_NONBLOCKING;

  OrganStiffness organ_;
  ToolSettings target_;
  LiveParameters from_, now_;
  Choice from_choice_, choice_;
  double left_{0.0};  // s
  bool jumped_{false};
};

}  // namespace palpate
