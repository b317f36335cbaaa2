// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdio>
#include <string>

namespace palpate::program {

/// What printf would print, of any length. @param[in] format  with the values' own types: no std::string
template <class... Values>
[[nodiscard]] std::string printed(const char* format, Values... values) {
  std::string text(static_cast<std::size_t>(std::snprintf(nullptr, 0, format, values...)), '\0');
  std::snprintf(text.data(), text.size() + 1, format, values...);
  return text;
}

}  // namespace palpate::program
