// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "tools/solver/build/case_file.h"

namespace palpate::solver {

/// What a case says, one "table.key = value" for each key that it gives, by the names of case files: two cases with the same lines
/// are the same solve. Without the mesh's path and the case's text.
[[nodiscard]] std::vector<std::string> linesOf(const Case& c);

}  // namespace palpate::solver
