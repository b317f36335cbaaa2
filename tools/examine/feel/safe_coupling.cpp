// SPDX-License-Identifier: Apache-2.0
#include "tools/examine/feel/safe_coupling.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "tools/program/printed.h"

namespace palpate::feel {
namespace {

constexpr std::size_t kPress = 4000;  // periods of a press
constexpr double kStep = 1.25;
constexpr double kLeast = 0.02;  // of the preset's; softer than that is no organ
constexpr double kTolerance = 1.03;

}  // namespace

DevicePreset withRendered(DevicePreset preset, double stiffness) noexcept {
  preset.coupling_damping *= stiffness / preset.rendered_stiffness;
  preset.rendered_stiffness = stiffness;
  return preset;
}

std::vector<StabilityCase> casesUnder(const device::Delays& delays, const DevicePreset& preset,
                                      const ContactPoint& s, double organ_stiffness, double youngs_modulus) {
  std::vector<StabilityCase> cases;
  for (const bool friction : {false, true})  // the harder first
    for (const std::size_t first : {delays.worstStretch(kPress), std::size_t{0}})
      for (const device::Hand& hand : kHands)
        cases.push_back({preset, youngs_modulus, hand, s, organ_stiffness, friction, &delays, first});
  return cases;
}

std::optional<StabilityCase> firstUnstable(const MetaModel& model, std::span<const StabilityCase> cases) {
  const auto found = std::find_if(cases.begin(), cases.end(), [&](const StabilityCase& which) {
    return !press(model, which, std::nullopt).stable;
  });
  return found == cases.end() ? std::nullopt : std::optional(*found);
}

SafeCoupling safeCoupling(const MetaModel& model, const device::Delays& delays, const DevicePreset& preset,
                          const ContactPoint& s, double organ_stiffness) {
  const double stiffest = kModuli.back(), most = preset.rendered_stiffness / kSafeShare;
  SafeCoupling safe;
  const auto stable = [&](double stiffness, double E) {
    const auto rings =
        firstUnstable(model, casesUnder(delays, withRendered(preset, stiffness), s, organ_stiffness, E));
    if (rings) safe.rings = rings;
    return !rings;
  };
  // 1. Upward on the stiffest organ, where the coupling is all that gives way.
  double low = 0.0, high = kLeast * most;
  bool holds = stable(high, stiffest);
  for (; holds && high < most; holds = stable(high, stiffest)) {
    low = high;
    high = std::min(kStep * high, most);
  }
  // 2. Between the last stable one and the first unstable one.
  if (holds) low = most;
  while (!holds && low > 0.0 && high > kTolerance * low) {
    const double middle = std::sqrt(low * high);
    (stable(middle, stiffest) ? low : high) = middle;
  }
  // 3. Softer organs.
  const auto on_softer = [&](double E) { return stable(low, E); };
  while (low > kLeast * most && !std::all_of(kModuli.begin(), kModuli.end() - 1, on_softer)) {
    high = low;
    low /= kTolerance;
    holds = false;
  }
  safe.by_device = holds;
  safe.largest_stable = low;
  safe.rendered_stiffness = std::min(kSafeShare * low, preset.rendered_stiffness);
  safe.damping = withRendered(preset, safe.rendered_stiffness).coupling_damping;
  safe.unstable_at = safe.by_device ? 0.0 : high;
  return safe;
}

std::string settingOf(const DevicePreset& preset, const SafeCoupling& coupling, const std::string& origin) {
  const std::string name(preset.name);
  return "# The stiffest that device " + name +
         " may be given under measured delays: palpate-server --config FILE\n# " + origin + "\ndevice = \"" +
         name + "\"\n\n[tool]\n" +
         program::printed("rendered_stiffness = %.6g  # N/m, of organ and coupling in series\n",
                          coupling.rendered_stiffness) +
         program::printed("coupling_damping = %.6g  # N s/m\n", coupling.damping);
}

}  // namespace palpate::feel
