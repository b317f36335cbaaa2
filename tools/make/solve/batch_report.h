// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

#include "tools/make/solve/batch_case.h"
#include "tools/program/json.h"

namespace palpate::solve_program {

/// "90 s", "12 min", "3.5 h".
[[nodiscard]] std::string spanText(double seconds);

/// What became of each case, as --json prints it (docs/json.md).
[[nodiscard]] program::Json batchReport(const Options& options, std::span<const BatchCase> cases,
                                        double seconds);

/// The same for people, one line a case. @param report  batchReport() of them
[[nodiscard]] std::string batchTable(std::span<const BatchCase> cases, const program::Json& report);

}  // namespace palpate::solve_program
