// SPDX-License-Identifier: Apache-2.0
#include "core/tick/live_blend.h"

#include <algorithm>
#include <cmath>

#include "core/tick/step_config.h"

namespace palpate {

namespace {

constexpr double kMostFriction = kLiveParameters[1].high;
static_assert(kLiveFields<LiveParameters>[1] == &LiveParameters::friction);

/// From a to b; at once when one of them is infinite.
double mix(double a, double b, double weight) noexcept PALPATE_NONBLOCKING {
  if (a == b || weight >= 1.0 || std::isinf(a) || std::isinf(b)) return b;
  return (1.0 - weight) * a + weight * b;
}

bool switched(double a, double b) noexcept PALPATE_NONBLOCKING {
  return std::isinf(a) != std::isinf(b);
}

}  // namespace

LiveBlend::LiveBlend(const LiveParameters& parameters, double model_modulus) noexcept
    : model_modulus_(model_modulus), from_(resolved(parameters)), target_(from_), now_(from_) {}

LiveParameters LiveBlend::resolved(const LiveParameters& parameters) const noexcept PALPATE_NONBLOCKING {
  LiveParameters out = parameters;
  if (out.youngs_modulus == 0.0) out.youngs_modulus = model_modulus_;
  return out;
}

void LiveBlend::start(const LiveParameters& wanted, double largest_force) noexcept PALPATE_NONBLOCKING {
  jumped_ = switched(now_.friction, wanted.friction) || switched(now_.force_limit, wanted.force_limit) ||
            switched(now_.coupling_stiffness, wanted.coupling_stiffness) ||
            wanted.force_rate_limit > std::max(now_.force_rate_limit, target_.force_rate_limit);
  from_ = now_;
  if (std::isinf(from_.friction)) from_.friction = std::max(kMostFriction, wanted.friction);
  if (std::isinf(from_.force_limit)) from_.force_limit = std::max(largest_force, wanted.force_limit);
  target_ = wanted;
  left_ = kSeconds;
}

void LiveBlend::advance(const LiveParameters& target, double dt,
                        double largest_force) noexcept PALPATE_NONBLOCKING {
  jumped_ = false;
  const LiveParameters wanted = resolved(target);
  if (!(wanted == target_)) start(wanted, largest_force);
  if (left_ <= 0.0) return;
  left_ = std::max(0.0, left_ - dt);
  const double weight = 1.0 - left_ / kSeconds;
  for (double LiveParameters::*field : kLiveFields<LiveParameters>)
    now_.*field = mix(from_.*field, target_.*field, weight);
  now_.coupling_stiffness =
      switched(from_.coupling_stiffness, target_.coupling_stiffness) || weight >= 1.0
          ? target_.coupling_stiffness
          : 1.0 / mix(1.0 / from_.coupling_stiffness, 1.0 / target_.coupling_stiffness, weight);
  now_.coupling_damping = std::min(now_.coupling_damping, kLongestCouplingTime * now_.coupling_stiffness);
}

}  // namespace palpate
