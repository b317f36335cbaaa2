// SPDX-License-Identifier: Apache-2.0
#include "tools/make/organ/odd_length.h"

#include <cmath>

#include "tools/program/length_unit.h"
#include "tools/program/printed.h"

namespace palpate::organ {
namespace {

using program::LengthUnit;
using program::printed;

constexpr double kSmallOrgan = 0.02, kLargeOrgan = 0.6;  // m, what a unit is suspected to lead to
constexpr double kUsual = 0.2;                           // m, an organ as long as a liver

// The unit that makes an organ of it, the most usual one where several do.
const LengthUnit* suspected(double length_in_file) {
  const LengthUnit* best = nullptr;
  const auto oddness = [&](const LengthUnit& unit) {
    return std::abs(std::log(length_in_file * unit.metres / kUsual));
  };
  for (const LengthUnit& unit : program::kLengthUnits) {
    const double length = length_in_file * unit.metres;
    if (length < kSmallOrgan || length > kLargeOrgan) continue;
    if (best == nullptr || oddness(unit) < oddness(*best)) best = &unit;
  }
  return best;
}

}  // namespace

std::optional<std::string> oddLength(double length, double scale) {
  if (program::isOrganLength(length)) return std::nullopt;
  const std::string words = printed("the body is %.4g m long, implausible for an organ", length);
  const LengthUnit* const unit = suspected(length / scale);
  if (unit == nullptr) return words + ": is --unit or --scale right?";
  const std::string word(unit->word);
  return words + printed(": is the file in %s? --unit %s makes it %.3g m long", word.c_str(), word.c_str(),
                         length / scale * unit->metres);
}

}  // namespace palpate::organ
