// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "tools/make/solve/options.h"
#include "tools/solver/base/checkpoint.h"
#include "tools/solver/base/ranks.h"
#include "tools/solver/build/case_file.h"

namespace palpate::solve_program {

/// Whether the case's method goes on where it was killed.
[[nodiscard]] bool keepsItsWork(const solver::Case& c);

/// The folder OUTPUT.partial of a solve, in the scratch folder; says on standard error that it goes on. Null for the methods that
/// keep nothing.
/// @throw solver::CheckpointError  the folder is of another case, mesh, program, version of OpenBLAS or kind of processor, or in use; or another number of ranks,
///        or one that has another case, mesh, program or processor than the first
/// Each rank has a folder of its own: OUTPUT.partial, OUTPUT.partial.1 and so on.
[[nodiscard]] std::unique_ptr<solver::Checkpoint> checkpointOf(const Options& options, const solver::Case& c,
                                                               const solver::Ranks& ranks);

}  // namespace palpate::solve_program
