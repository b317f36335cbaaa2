// SPDX-License-Identifier: Apache-2.0
#include "tools/examine/feel/stability.h"

#include <algorithm>

#include "core/devices/path/path.h"
#include "core/devices/sim/closed_loop.h"
#include "core/devices/sim/motion.h"
#include "tools/examine/feel/player.h"

namespace palpate::feel {

namespace {

device::Point pointOf(const Vec3& v) {
  return {v.x(), v.y(), v.z()};
}

device::Mechanics mechanicsOf(const StabilityCase& which) {
  device::Mechanics mechanics = device::mechanicsOf(which.preset);
  if (!which.friction) mechanics.friction = 0.0;
  return mechanics;
}

StepConfig configOf(const StabilityCase& which, std::optional<double> coupling_stiffness) {
  StepConfig config;
  apply(which.preset, config);
  config.organ_stiffness = which.organ_stiffness;
  config.youngs_modulus = which.youngs_modulus;
  if (!coupling_stiffness) return config;
  config.coupling_damping *= *coupling_stiffness / config.rendered_stiffness;
  config.coupling_stiffness = *coupling_stiffness;
  config.rendered_stiffness = StepConfig{}.rendered_stiffness;
  return config;
}

}  // namespace

device::Verdict press(const MetaModel& model, const StabilityCase& which,
                      std::optional<double> coupling_stiffness) {
  const device::Mechanics mechanics = mechanicsOf(which);
  const StepConfig config = configOf(which, coupling_stiffness);
  device::MotionOptions options;
  options.tip_radius = config.tip_radius;
  options.lead = device::leadOf(mechanics, which.hand);
  const device::Motion motion = device::makeMotion("press", pointOf(model.surface().position(which.s)),
                                                   pointOf(model.surface().normal(which.s)), options);
  device::HeldDevice held(mechanics, which.hand, motion.path);
  const device::HeldDevice other = held;
  Player player(model, config);
  const auto force_at = [&](const device::Point& c, bool is_new = true) {
    return pointOf(forceOf(is_new ? player.at(Vec3(c[0], c[1], c[2])) : player.again()));
  };
  const device::Trace with =
      which.delays == nullptr ? device::closedLoop(held, motion, force_at)
                              : device::closedLoop(held, motion, force_at, *which.delays, which.first_delay);
  return device::judge(with, device::withoutOrgan(other, motion), motion);
}

double defaultCoupling(const MetaModel& model, const StabilityCase& which) {
  return Workspace(model, configOf(which, std::nullopt)).live().coupling_stiffness;
}

StabilityResult stability(const MetaModel& model, const StabilityCase& which) {
  constexpr int kBisections = 5;  // of a factor of two: 3 %
  StabilityResult result;
  double low = 0.0, high = which.preset.rendered_stiffness;
  result.at_default = press(model, which, std::nullopt);
  for (bool stable = press(model, which, high).stable; stable; stable = press(model, which, high).stable) {
    result.largest_stable = low = high;
    if (high == kStiffestCoupling) return result;
    high = std::min(2.0 * high, kStiffestCoupling);
  }
  for (int i = 0; i < kBisections; ++i) {
    const double middle = 0.5 * (low + high);
    (press(model, which, middle).stable ? low : high) = middle;
  }
  result.largest_stable = low;
  return result;
}

}  // namespace palpate::feel
