// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "tools/modelfile/model_data.h"
#include "tools/solver/build/build_options.h"
#include "tools/solver/build/case_file.h"

namespace palpate::solve_program {

/// SHA-256 of a file, in hexadecimal. @throw std::runtime_error
[[nodiscard]] std::string fileHash(const std::filesystem::path& path);

/// All that decides which model a case becomes, one "name = value" each.
/// @param mesh_hash  fileHash() of its mesh just before that was read
[[nodiscard]] std::vector<std::string> linesOf(const solver::Case& c, const std::string& mesh_hash);

/// Fills in provenance: program, time, case, mesh with its SHA-256, the lines of both, timings, error of the fit after each sweep or
/// what the pairs leave, load.
void addProvenance(modelfile::ModelData& data, const solver::Case& c, const std::string& mesh_hash,
                   const solver::BuildReport& report);

}  // namespace palpate::solve_program
