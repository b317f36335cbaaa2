// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "tools/modelfile/mixed_precision.h"
#include "tools/modelfile/model_data.h"
#include "tools/program/json.h"
#include "tools/solver/build/build_options.h"
#include "tools/solver/build/case_file.h"

namespace palpate::solve_program {

/// What the model's fields are off by, over the displacement: the fit's RMS error, or what the pairs leave.
[[nodiscard]] double ownError(const solver::BuildReport& report);

[[nodiscard]] program::Json toJson(const modelfile::StorageReport& storage);

/// Seconds by what was done, in the method's own stages.
[[nodiscard]] program::Json stages(solver::Method method, const solver::BuildReport& report);

/// The load of a load-driven model: N, direction (three numbers or "any"), and what the PGD made of it.
/// Empty for the series methods.
[[nodiscard]] program::Json loadOf(const solver::Case& c, const solver::BuildReport& report);

/// What came out, as --json prints it (docs/json.md). The model has been written.
[[nodiscard]] program::Json summarize(const std::filesystem::path& output, const solver::Case& c,
                                      const modelfile::ModelData& data, const solver::BuildReport& report,
                                      const modelfile::StorageReport& storage, double write_seconds,
                                      double total_seconds);

/// The same in five lines on standard error.
void print(const program::Json& summary);

}  // namespace palpate::solve_program
