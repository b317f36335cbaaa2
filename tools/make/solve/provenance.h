// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "tools/modelfile/model_data.h"
#include "tools/solver/build/build_options.h"
#include "tools/solver/build/case_file.h"

namespace palpate::solve_program {

/// SHA-256 of a file, in hexadecimal.
[[nodiscard]] std::string fileHash(const std::filesystem::path& path);

/// Fills in provenance: program, time, case, mesh
/// with its SHA-256, timings, error of the fit after each sweep or what the pairs leave, load.
void addProvenance(modelfile::ModelData& data, const solver::Case& c, const solver::BuildReport& report);

}  // namespace palpate::solve_program
