// SPDX-License-Identifier: Apache-2.0
#include "core/tick/coupling_damper.h"

#include <algorithm>

namespace palpate {

Vec3 CouplingDamper::force(const Contact& contact, double time_constant,
                           double dt) noexcept PALPATE_NONBLOCKING {
  constexpr double kSmoothing = 2e-3;  // s: two ticks at 1 kHz, so that a tick without a new pose is no stop
  const Vec3& f = contact.coupled.response.force;
  const bool goes_on = holding_ && !contact.jumped() && !contact.isFree();
  dt += waited_;
  waited_ = 0.0;
  if (goes_on && dt > 0.0) rate_ += (dt / (dt + kSmoothing)) * ((f - spring_) / dt - rate_);
  if (!goes_on) rate_.setZero();
  spring_ = f;
  holding_ = !contact.isFree();
  Vec3 damping = time_constant * rate_;
  const double size = damping.norm(), most = f.norm();
  if (size > most) damping *= most / size;
  const double push = -f.dot(contact.normal), pull = damping.dot(contact.normal);
  if (pull > push) damping *= std::max(0.0, push) / pull;
  return f + damping;
}

}  // namespace palpate
