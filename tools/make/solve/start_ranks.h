// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tools/solver/base/ranks.h"

namespace palpate::solve_program {

/// The processes that a launcher (mpirun) has started with this one; by itself, the only one. Of a program that is built without
/// MPI, always the only one. Call it once.                                               docs/decisions/ranks.md
/// @throw program::UsageError  the launcher is of another MPI
[[nodiscard]] const solver::Ranks& startRanks();

/// Ends this process's part. @param code  not 0: all processes end now, with this exit code
void endRanks(int code);

}  // namespace palpate::solve_program
