// SPDX-License-Identifier: Apache-2.0
#include "tools/program/length_unit.h"

#include <algorithm>
#include <cmath>

#include "tools/program/numbers.h"
#include "tools/program/printed.h"

namespace palpate::program {

namespace {

std::string awayText(double distance) {
  return distance < 0.0 ? "inside the organ, " + lengthText(-distance) + " from its surface"
                        : lengthText(distance) + " from the organ's surface";
}

/// In which other unit the place would be on the organ; empty where in none.
std::string suspicion(const AskedPlace& place, double radius, const SurfaceDistance& distance) {
  for (const LengthUnit& unit : kLengthUnits) {
    if (unit.word == place.unit.word) continue;
    const double away = distance(place.inMetres(unit));
    if (!(std::abs(away) <= radius)) continue;
    return "; in " + std::string(unit.plural) + " it would lie " + awayText(away) +
           (place.has_option ? ": --unit " + std::string(unit.word) : ": give metres");
  }
  return {};
}

}  // namespace

std::vector<std::string> lengthUnitWords() {
  std::vector<std::string> words;
  for (const LengthUnit& unit : kLengthUnits) words.emplace_back(unit.word);
  return words;
}

const LengthUnit& lengthUnit(std::string_view word) {
  const auto found = std::find_if(kLengthUnits.begin(), kLengthUnits.end(),
                                  [&](const LengthUnit& unit) { return unit.word == word; });
  if (found == kLengthUnits.end())
    throw ValueError("unit '" + std::string(word) + "' is not known (known: m, cm, mm)");
  return *found;
}

std::string lengthText(double metres) {
  return std::abs(metres) < 1.0 ? printed("%.4g mm", 1e3 * metres) : printed("%.4g m", metres);
}

void checkNear(const AskedPlace& place, double radius, const SurfaceDistance& distance) {
  const double away = distance(place.inMetres());
  if (std::abs(away) <= radius) return;
  throw ValueError(
      place.name + printed(" %.9g,%.9g,%.9g ", place.numbers[0], place.numbers[1], place.numbers[2]) +
      std::string(place.unit.word) + " lies " + awayText(away) + ", expected at most " + lengthText(radius) +
      ", the radius of the contact patch" + suspicion(place, radius, distance));
}

}  // namespace palpate::program
