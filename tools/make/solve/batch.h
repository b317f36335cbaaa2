// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tools/make/solve/options.h"

namespace palpate::solve_program {

/// Solves the cases of the folder options.batch, in the order of their names, each in a process of its own; of options.worker's share.
/// Those whose model is there are left, and so are those that another program solves now. Prints what came out of each.
///                                                                                       docs/decisions/batches.md
/// @return program::kFailed where one failed  @throw program::UsageError, std::runtime_error  nothing was begun
[[nodiscard]] int solveBatch(const Options& options);

}  // namespace palpate::solve_program
