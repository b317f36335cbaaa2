// SPDX-License-Identifier: Apache-2.0
#include "palpate/core/live_blend.h"

#include <algorithm>
#include <cmath>

namespace palpate {

namespace {

bool same(const LiveParameters& a, const LiveParameters& b) noexcept {
  return a.youngs_modulus == b.youngs_modulus && a.friction == b.friction &&
         a.coupling_stiffness == b.coupling_stiffness && a.coupling_damping == b.coupling_damping &&
         a.force_limit == b.force_limit && a.force_rate_limit == b.force_rate_limit;
}

/// From a to b; one that is infinite counts as `most` on the way.
double mix(double a, double b, double weight, double most) noexcept {
  if (weight >= 1.0) return b;
  if (a == b) return a;
  return (1.0 - weight) * std::min(a, most) + weight * std::min(b, most);
}

}  // namespace

LiveBlend::LiveBlend(const LiveParameters& parameters, double model_modulus) noexcept
    : model_modulus_(model_modulus), from_(resolved(parameters)), target_(from_), now_(from_) {}

LiveParameters LiveBlend::resolved(const LiveParameters& parameters) const noexcept {
  LiveParameters out = parameters;
  if (out.youngs_modulus == 0.0) out.youngs_modulus = model_modulus_;
  return out;
}

void LiveBlend::advance(const LiveParameters& target, double dt) noexcept PALPATE_NONBLOCKING {
  constexpr double kMostFriction = 2.0, kMostForce = 50.0,
                   kMostRate = 1e6;  // the ends of StepConfig's ranges
  const LiveParameters wanted = resolved(target);
  if (!same(wanted, target_)) {
    from_ = now_;
    target_ = wanted;
    left_ = kSeconds;
  }
  if (left_ <= 0.0) return;
  left_ = std::max(0.0, left_ - dt);
  const double weight = 1.0 - left_ / kSeconds;
  const double compliance = (1.0 - weight) / from_.coupling_stiffness +
                            weight / target_.coupling_stiffness;  // 0 of an infinite one
  now_.youngs_modulus = mix(from_.youngs_modulus, target_.youngs_modulus, weight, INFINITY);
  now_.friction = mix(from_.friction, target_.friction, weight, kMostFriction);
  now_.coupling_stiffness = weight >= 1.0 ? target_.coupling_stiffness : 1.0 / compliance;
  now_.coupling_damping = mix(from_.coupling_damping, target_.coupling_damping, weight, INFINITY);
  now_.force_limit = mix(from_.force_limit, target_.force_limit, weight, kMostForce);
  now_.force_rate_limit = mix(from_.force_rate_limit, target_.force_rate_limit, weight, kMostRate);
}

}  // namespace palpate
