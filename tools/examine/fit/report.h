// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "tools/examine/fit/findings.h"
#include "tools/program/json.h"

namespace palpate::fit {

/// The object of --json; keys in docs/json.md.
[[nodiscard]] program::Json toJson(const Findings& found);

/// The same for a person to read, several lines.
[[nodiscard]] std::string toText(const Findings& found);

/// What makes the result doubtful, one sentence each.
[[nodiscard]] std::vector<std::string> warnings(const Findings& found);

}  // namespace palpate::fit
