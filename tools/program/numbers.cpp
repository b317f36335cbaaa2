// SPDX-License-Identifier: Apache-2.0
#include "tools/program/numbers.h"

#include <algorithm>
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

std::vector<double> niceTicks(double low, double high, int count) {
  const double rough = (high - low) / std::max(count, 1);
  const double decade = std::pow(10.0, std::floor(std::log10(rough)));
  double step = 10.0 * decade;
  for (const double factor : {1.0, 2.0, 5.0})
    if (factor * decade >= rough * (1.0 - 1e-9)) {
      step = factor * decade;
      break;
    }
  std::vector<double> ticks;
  const auto first = static_cast<long>(std::floor(low / step + 1e-9));
  const auto last = static_cast<long>(std::ceil(high / step - 1e-9));
  for (long i = first; i <= last; ++i) ticks.push_back(static_cast<double>(i) * step);
  return ticks;
}

}  // namespace palpate::program
