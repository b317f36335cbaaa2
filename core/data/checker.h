// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <span>
#include <string>

#include "core/data/load_error.h"

namespace palpate {

/// 12 digits of a number: the last ones may be what is wrong.
inline std::string digitsOf(double value) {
  std::array<char, 32> digits{};
  std::snprintf(digits.data(), digits.size(), "%.12g", value);
  return digits.data();
}

/// Says what is wrong with the numbers of one file. What goes over arrays is not inlined: a browser optimizes functions
/// that loop, and one function of all checks took it longer than the checks take.
class Checker {
 public:
  explicit Checker(const std::string& name) : name_(name) {}

  void require(bool good, const std::string& found, const std::string& expected) const {
    if (!good) throw LoadError(name_ + ": " + found + ", expected " + expected);
  }

  template <typename T>
  [[gnu::noinline]] void finite(const std::string& dataset, std::span<const T> values) const {
    for (std::size_t i = 0; i < values.size(); ++i)
      if (!std::isfinite(values[i]))
        failAt(dataset, i, "is " + digitsOf(double(values[i])), "a finite number");
  }

  /// Each value is an index below `end`, and at least `begin` (0, or -1 where "none" is allowed).
  [[gnu::noinline]] void indices(const std::string& dataset, std::span<const std::int32_t> values,
                                 std::size_t end, std::int32_t begin = 0) const {
    for (std::size_t i = 0; i < values.size(); ++i)
      if (values[i] < begin || (values[i] >= 0 && static_cast<std::size_t>(values[i]) >= end))
        failAt(dataset, i, "is " + std::to_string(values[i]),
               std::to_string(begin) + " to " + std::to_string(end - 1));
  }

  [[noreturn]] void failAt(const std::string& dataset, std::size_t i, const std::string& found,
                           const std::string& expected) const {
    throw LoadError(name_ + ": " + dataset + " number " + std::to_string(i) + " " + found + ", expected " +
                    expected);
  }

 private:
  const std::string& name_;
};

}  // namespace palpate
