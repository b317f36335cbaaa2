// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "tools/modelfile/model_data.h"
#include "tools/program/json.h"
#include "tools/solver/build/build_options.h"
#include "tools/solver/build/case_file.h"

namespace palpate::solve_program {

/// mean, max, points. @param report  with a mesh error
[[nodiscard]] program::Json meshErrorOf(const solver::BuildReport& report);

/// What of a handheld file goes where. @param report  with a size
[[nodiscard]] program::Json sizeOf(const solver::BuildReport& report);

/// Seconds by what was done, in the method's own stages.
[[nodiscard]] program::Json stages(solver::Method method, const solver::BuildReport& report);

/// The load of a load-driven model: N, direction (three numbers or "any"), and what the PGD made of it.
/// Empty for the series methods.
[[nodiscard]] program::Json loadOf(const solver::Case& c, const solver::BuildReport& report);

/// What came out, as --json prints it (docs/json.md). The model has been written.
[[nodiscard]] program::Json summarize(const std::filesystem::path& output, const solver::Case& c,
                                      const modelfile::ModelData& data, const solver::BuildReport& report,
                                      double write_seconds, double total_seconds);

/// The same for people, on standard error.
void print(const program::Json& summary);

}  // namespace palpate::solve_program
