// SPDX-License-Identifier: Apache-2.0
#include "core/tick/live_blend.h"

#include <algorithm>
#include <cmath>

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

LiveBlend::LiveBlend(const ToolSettings& settings, const OrganStiffness& organ) noexcept
    : organ_(organ),
      target_(resolved(settings)),
      from_(target_.live),
      now_(target_.live),
      from_choice_(choiceOf(target_)),
      choice_(from_choice_) {
  now_.coupling_stiffness = couplingOf(choice_, now_.youngs_modulus);
}

LiveBlend::Choice LiveBlend::choiceOf(const ToolSettings& settings) noexcept PALPATE_NONBLOCKING {
  return {1.0 / settings.live.coupling_stiffness, 1.0 / settings.rendered_stiffness};
}

ToolSettings LiveBlend::resolved(const ToolSettings& settings) const noexcept PALPATE_NONBLOCKING {
  ToolSettings out = settings;
  out.tip_radius = 0.0;
  if (out.live.youngs_modulus == 0.0) out.live.youngs_modulus = organ_.youngs_modulus;
  return out;
}

double LiveBlend::couplingOf(const Choice& choice, double E) const noexcept PALPATE_NONBLOCKING {
  return 1.0 / couplingCompliance(choice.asked, choice.rendered, organ_, E);
}

void LiveBlend::start(const ToolSettings& wanted, double largest_force) noexcept PALPATE_NONBLOCKING {
  const Choice choice = choiceOf(wanted);
  const bool coupled =  // or no longer, and not because the organ becomes stiffer or softer
      !(choice == choice_) &&
      switched(now_.coupling_stiffness, couplingOf(choice, wanted.live.youngs_modulus));
  jumped_ = switched(now_.friction, wanted.live.friction) ||
            switched(now_.force_limit, wanted.live.force_limit) || coupled ||
            wanted.live.force_rate_limit > std::max(now_.force_rate_limit, target_.live.force_rate_limit);
  from_ = now_;
  from_choice_ = coupled ? choice : choice_;
  if (std::isinf(from_.friction)) from_.friction = std::max(kMostFriction, wanted.live.friction);
  if (std::isinf(from_.force_limit)) from_.force_limit = std::max(largest_force, wanted.live.force_limit);
  target_ = wanted;
  left_ = kSeconds;
}

void LiveBlend::advance(const ToolSettings& target, double dt,
                        double largest_force) noexcept PALPATE_NONBLOCKING {
  jumped_ = false;
  const ToolSettings wanted = resolved(target);
  if (!(wanted == target_)) start(wanted, largest_force);
  if (left_ <= 0.0) return;
  left_ = std::max(0.0, left_ - dt);
  const double weight = 1.0 - left_ / kSeconds;
  const LiveParameters& goal = target_.live;
  for (double LiveParameters::*field : kLiveFields<LiveParameters>)
    now_.*field = mix(from_.*field, goal.*field, weight);
  if (left_ > 0.0)
    now_.youngs_modulus = from_.youngs_modulus * std::pow(goal.youngs_modulus / from_.youngs_modulus, weight);
  const Choice choice = choiceOf(target_);
  choice_ = {mix(from_choice_.asked, choice.asked, weight),
             mix(from_choice_.rendered, choice.rendered, weight)};
  now_.coupling_stiffness = couplingOf(choice_, now_.youngs_modulus);
  now_.coupling_damping = std::min(now_.coupling_damping, kLongestCouplingTime * (1.0 / softest(choice_)));
}

}  // namespace palpate
