// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <string>

namespace palpate::dds {

/// What others send is printed: at most `longest` characters, without those that would move a terminal's cursor or begin another
/// line. @param[in] text  nullptr is empty
[[nodiscard]] inline std::string printable(const char* text, std::size_t longest = 64) {
  std::string shown = text == nullptr ? "" : std::string(text).substr(0, longest);
  std::replace_if(
      shown.begin(), shown.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
  return shown;
}

}  // namespace palpate::dds
