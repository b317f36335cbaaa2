// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sstream>
#include <stdexcept>
#include <type_traits>

namespace palpate::device {

/// @throw Error  "NAME is 7, expected 0 to 3" when the value is outside [low, high] or not a number
template <class Error, class Number>
void inRange(const char* name, Number value, std::type_identity_t<Number> low,
             std::type_identity_t<Number> high) {
  if (value >= low && value <= high) return;
  std::ostringstream line;
  line << name << " is " << value << ", expected " << low << " to " << high;
  throw Error(line.str());
}

/// inRange() of what a caller of a function gives. @throw std::invalid_argument
inline constexpr auto& requireRange = inRange<std::invalid_argument, double>;

}  // namespace palpate::device
