// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tools/program/json.h"
#include "tools/solver/build/build_options.h"
#include "tools/solver/build/case_file.h"
#include "tools/solver/build/estimate.h"

namespace palpate::solve_program {

/// What --dry-run found, as --json prints it (docs/json.md).
[[nodiscard]] program::Json estimateOf(const solver::Estimate& estimate, const solver::Case& c,
                                       const solver::BuildReport& report);

/// The same for people, on standard output.
void printEstimate(const program::Json& estimate);

}  // namespace palpate::solve_program
