// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace palpate::program {

/// The text as XML content or as an attribute's value in double quotes: & < > " become entities.
[[nodiscard]] std::string xmlEscaped(std::string_view text);

}  // namespace palpate::program
