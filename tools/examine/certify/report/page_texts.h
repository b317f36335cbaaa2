// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "tools/program/json.h"

namespace palpate::certify {

/// A share in per cent; "unknown" where it is not a number.
[[nodiscard]] std::string percent(const program::Json& share);
/// @param length  m  @throw program::JsonError
[[nodiscard]] std::string millimetres(const program::Json& length);
/// @throw program::JsonError
[[nodiscard]] std::string countText(const program::Json& count);
/// The text; "unknown" where it is empty, or none.
[[nodiscard]] std::string known(const program::Json& text);

}  // namespace palpate::certify
