// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdio>
#include <string>

#include "core/base/types.h"

namespace palpate::query {

// What the reports are written with.

template <class... Values>
[[nodiscard]] std::string line(const char* format, Values... values) {
  std::array<char, 256> text{};
  std::snprintf(text.data(), text.size(), format, values...);
  return text.data();
}

/// "name x y z unit, size |v|", each times `factor`.
[[nodiscard]] inline std::string vectorLine(const char* name, const Vec3& v, double factor,
                                            const char* unit) {
  return line("%-14s %11.6g %11.6g %11.6g %s, size %.6g\n", name, factor * v[0], factor * v[1], factor * v[2],
              unit, factor * v.norm());
}

}  // namespace palpate::query
