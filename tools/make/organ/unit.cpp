// SPDX-License-Identifier: Apache-2.0
#include "tools/make/organ/unit.h"

#include <array>
#include <cmath>
#include <cstdio>

#include "tools/mesh/mesh_error.h"

namespace palpate::organ {
namespace {

struct Unit {
  const char* name;
  double metres;
};
constexpr std::array kUnits{Unit{"mm", 1e-3}, Unit{"cm", 1e-2}, Unit{"m", 1.0}};
constexpr double kShortest = 0.005, kLongest = 1;        // m, of what is not odd
constexpr double kSmallOrgan = 0.02, kLargeOrgan = 0.6;  // m, what a unit is suspected to lead to
constexpr double kUsual = 0.2;                           // m, an organ as long as a liver

// The unit that makes an organ of it, the most usual one where several do.
const Unit* suspected(double length_in_file) {
  const Unit* best = nullptr;
  const auto oddness = [&](const Unit& unit) {
    return std::abs(std::log(length_in_file * unit.metres / kUsual));
  };
  for (const Unit& unit : kUnits) {
    const double length = length_in_file * unit.metres;
    if (length < kSmallOrgan || length > kLargeOrgan) continue;
    if (best == nullptr || oddness(unit) < oddness(*best)) best = &unit;
  }
  return best;
}

}  // namespace

double metresOf(const std::string& unit) {
  for (const Unit& known : kUnits)
    if (unit == known.name) return known.metres;
  throw mesh::MeshError("--unit must be mm, cm or m, not " + unit);
}

std::optional<std::string> oddLength(double length, double scale) {
  if (length >= kShortest && length <= kLongest) return std::nullopt;
  char text[200];
  std::snprintf(text, sizeof text, "the body is %.4g m long, implausible for an organ", length);
  std::string words = text;
  if (const Unit* unit = suspected(length / scale)) {
    std::snprintf(text, sizeof text, ": is the file in %s? --unit %s makes it %.3g m long", unit->name,
                  unit->name, length / scale * unit->metres);
    words += text;
  } else {
    words += ": is --unit or --scale right?";
  }
  return words;
}

}  // namespace palpate::organ
