// SPDX-License-Identifier: Apache-2.0
#include "tools/examine/feel/safe_coupling.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "tools/program/printed.h"

namespace palpate::feel {
namespace {

constexpr std::size_t kPress = 4000;  // periods of a press
constexpr double kStep = 1.25;
constexpr double kLeast = 8.0;  // N/m; softer than that is no organ
constexpr double kTolerance = 1.03;

// At one place; of K_r, N/m, and E, Pa.
using StableThere = std::function<bool(double, double)>;

struct Bracket {
  double stable;         // the largest, N/m
  double unstable{0.0};  // the least; 0: none up to the end of the search
};

bool holdsOnSofter(double stiffness, const StableThere& stable) {
  return std::all_of(kModuli.begin(), kModuli.end() - 1, [&](double E) { return stable(stiffness, E); });
}

// What is safe of it, and a fifth less: a loop may ring there and be stable above.
bool holdsBelow(double stiffness, const StableThere& stable) {
  return stable(kSafeShare * stiffness, kModuli.back()) &&
         stable(kSafeShare * kSafeShare * stiffness, kModuli.back());
}

bool holdsAt(double stiffness, const StableThere& stable) {
  return stable(stiffness, kModuli.back()) && holdsBelow(stiffness, stable) &&
         holdsOnSofter(stiffness, stable);
}

Bracket searchBelow(double most, const StableThere& stable) {
  const double stiffest = kModuli.back(), least = std::min(kLeast, most);
  Bracket found{0.0};
  // 1. Upward on the stiffest organ, where the coupling is all that gives way.
  double high = least;
  bool holds = stable(high, stiffest);
  for (; holds && high < most; holds = stable(high, stiffest)) {
    found.stable = high;
    high = std::min(kStep * high, most);
  }
  if (holds) found.stable = most;
  // 2. Between the last stable one and the first unstable one.
  while (!holds && found.stable > 0.0 && high > kTolerance * found.stable) {
    const double middle = std::sqrt(found.stable * high);
    (stable(middle, stiffest) ? found.stable : high) = middle;
  }
  // 3. Softer organs.
  while (found.stable > least && !holdsOnSofter(found.stable, stable)) {
    high = found.stable;
    found.stable /= kTolerance;
    holds = false;
  }
  if (!holds) found.unstable = high;
  // 4. Where it rings below that, below that.
  if (found.stable > least && !holdsBelow(found.stable, stable)) {
    Bracket below = searchBelow(kSafeShare * found.stable, stable);
    const double share = stable(kSafeShare * found.stable, stiffest) ? kSafeShare * kSafeShare : kSafeShare;
    if (!(below.unstable > 0.0)) below.unstable = share * found.stable;
    return below;
  }
  return found;
}

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

SafeCoupling stiffestStable(std::span<const PressPlace> places, double most, const Stable& stable) {
  SafeCoupling safe;
  safe.largest_stable = most;
  // Round and round until no place lowers it: what a later place allows may ring at an earlier one that is stable above.
  std::size_t holding = 0;  // places in a row at which it holds
  for (std::size_t i = 0; holding < places.size() && safe.largest_stable > 0.0; ++i) {
    const PressPlace& place = places[i % places.size()];
    const auto there = [&](double stiffness, double E) { return stable(place, stiffness, E); };
    ++holding;
    if (i > 0 && holdsAt(safe.largest_stable, there)) continue;
    const Bracket found = searchBelow(safe.largest_stable, there);
    safe.largest_stable = found.stable;
    if (!(found.unstable > 0.0)) continue;
    safe.unstable_at = found.unstable;
    safe.place = place;
    holding = 1;
  }
  safe.by_device = !safe.place;
  return safe;
}

SafeCoupling safeCoupling(const MetaModel& model, const device::Delays& delays, const DevicePreset& preset,
                          std::span<const PressPlace> places, double organ_stiffness) {
  std::optional<StabilityCase> rings;
  const auto stable = [&](const PressPlace& place, double stiffness, double E) {
    const auto unstable = firstUnstable(
        model, casesUnder(delays, withRendered(preset, stiffness), place.s, organ_stiffness, E));
    if (unstable) rings = unstable;
    return !unstable;
  };
  SafeCoupling safe = stiffestStable(places, preset.rendered_stiffness / kSafeShare, stable);
  safe.rings = rings;
  safe.rendered_stiffness = std::min(kSafeShare * safe.largest_stable, preset.rendered_stiffness);
  safe.damping = withRendered(preset, safe.rendered_stiffness).coupling_damping;
  return safe;
}

std::string settingOf(const DevicePreset& preset, const SafeCoupling& coupling,
                      std::span<const std::string> origin) {
  const std::string name(preset.name);
  std::string text = "# The stiffest that device " + name +
                     " may be given under measured delays: palpate-server --config FILE\n";
  for (const std::string& line : origin) text += "# " + line + '\n';
  return text + "device = \"" + name + "\"\n\n[tool]\n" +
         program::printed("rendered_stiffness = %.6g  # N/m, of organ and coupling in series\n",
                          coupling.rendered_stiffness) +
         program::printed("coupling_damping = %.6g  # N s/m\n", coupling.damping);
}

}  // namespace palpate::feel
