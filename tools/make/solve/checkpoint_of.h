// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "tools/make/solve/options.h"
#include "tools/solver/base/checkpoint.h"
#include "tools/solver/base/ranks.h"
#include "tools/solver/build/case_file.h"

namespace palpate::solve_program {

/// Whether the case's method goes on where it was killed.
[[nodiscard]] bool keepsItsWork(const solver::Case& c);

/// Where one process keeps its work. @param options  scratch is given
[[nodiscard]] std::filesystem::path partialFolder(const Options& options);

/// The folder OUTPUT.partial of a solve, in the scratch folder; says on standard error that it goes on. Null for the methods that
/// keep nothing. Each rank has one of its own: OUTPUT.partial, OUTPUT.partial.1 and so on. What one rank is refused, all are.
/// @param solve  linesOf() the case and its mesh
/// @throw solver::CheckpointError  the folder is of another case, mesh, program, version of OpenBLAS, kind of processor or number
///        of ranks, or in use; or a rank has another case, mesh, program or processor than the first
[[nodiscard]] std::unique_ptr<solver::Checkpoint> checkpointOf(const Options& options, const solver::Case& c,
                                                               std::vector<std::string> solve,
                                                               const solver::Ranks& ranks);

}  // namespace palpate::solve_program
