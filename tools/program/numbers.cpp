// SPDX-License-Identifier: Apache-2.0
#include "tools/program/numbers.h"

#include <charconv>
#include <cmath>

namespace palpate::program {

std::optional<std::array<double, 3>> readVector(std::string_view text) {
  std::array<double, 3> vector{};
  const char* at = text.data();
  const char* const end = at + text.size();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto [next, failure] = std::from_chars(at, end, vector[axis]);
    const bool ends_well = axis < 2 ? next != end && *next == ',' : next == end;
    if (failure != std::errc() || !ends_well || !std::isfinite(vector[axis])) return std::nullopt;
    at = axis < 2 ? next + 1 : next;
  }
  return vector;
}

std::array<double, 3> parseVector(const std::string& option, const std::string& text) {
  if (const auto vector = readVector(text)) return *vector;
  throw ValueError(option + " is '" + text + "', expected three finite numbers x,y,z");
}

}  // namespace palpate::program
