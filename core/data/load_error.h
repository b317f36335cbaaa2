// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>

namespace palpate {

/// What a file or its parser says, for a terminal: each byte but printable ASCII becomes a question mark.
[[nodiscard]] inline std::string printable(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](char letter) { return letter < ' ' || letter > '~'; }, '?');
  return text;
}

/// A model file that cannot be used. what() is one sentence: file, dataset, what was found, what was
/// expected. It is one line whatever the file holds: control characters in it become question marks.
class LoadError : public std::runtime_error {
 public:
  explicit LoadError(std::string what) : std::runtime_error(oneLine(std::move(what))) {}

 private:
  static std::string oneLine(std::string text) {
    constexpr unsigned char kFirstPrinted = ' ', kDelete = 0x7f;
    const auto controls = [](unsigned char letter) { return letter < kFirstPrinted || letter == kDelete; };
    std::replace_if(text.begin(), text.end(), controls, '?');
    return text;
  }
};

}  // namespace palpate
