// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "tools/program/exit_code.h"

namespace palpate::program {

/// The value of an option that does not read as what it stands for. what() is one line with option and value.
class ValueError : public UsageError {
 public:
  using UsageError::UsageError;
};

/// "x,y,z" as three finite numbers; nothing when the text is anything else.
[[nodiscard]] std::optional<std::array<double, 3>> readVector(std::string_view text);

/// The same. @param[in] option  for the message  @throw ValueError
[[nodiscard]] std::array<double, 3> parseVector(const std::string& option, const std::string& text);

/// Round numbers (1, 2 or 5 times a power of ten) that cover [low, high] with about `count` steps.
[[nodiscard]] std::vector<double> niceTicks(double low, double high, int count);

}  // namespace palpate::program
