// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/types.h"
#include "core/contact/contact.h"

namespace palpate {

/// The damper beside the coupling's spring:  f + b de/dt,  e = f / K_vc the spring's stretch.   docs/design.md, Contact
/// So it is f + (b / K_vc) df/dt, which needs no velocity of the tool; df/dt is smoothed over 2 ms. The force
/// with the damper never pulls and is at most twice the spring's: the damper starts and ends with the contact, without a step.
/// Where the coupling follows the organ, b / K_vc is that of a rigid organ (LiveBlend::dampingTime()), so that a soft organ
/// which needs no spring is damped too.
/// In its first tick a step of the pose meets the stiffness K (1 + (b / K_vc) / (dt + 2 ms)), K <= K_vc the spring's and
/// the organ's in series: a device renders that much (device_preset.h).
/// Differs from a damper inside the balance of forces: the organ does not feel it, and the stiffness that is
/// rendered stays the spring's and the organ's.
class CouplingDamper {
 public:
  /// Force of the tool on the organ, spring and damper, N. @param time_constant  b / K_vc, s, @param dt  s since the
  /// last call. Real-time: yes.
  [[nodiscard]] Vec3 force(const Contact& contact, double time_constant,
                           double dt) noexcept PALPATE_NONBLOCKING;
  /// A tick without a force: the next change of the spring took so much longer. Real-time: yes.
  void wait(double dt) noexcept PALPATE_NONBLOCKING { waited_ += dt; }

 private:
  Vec3 spring_ = Vec3::Zero();  // f of the last tick, N
  Vec3 rate_ = Vec3::Zero();    // df/dt, smoothed, N/s
  double waited_{0.0};          // s since the last force(), less its dt
  bool holding_{false};         // there was a contact in the last tick
};

}  // namespace palpate
