// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tools/make/solve/options.h"
#include "tools/program/json.h"
#include "tools/solver/base/ranks.h"

namespace palpate::solve_program {

/// Solves one case: reads it and its mesh, writes the model and its .xdmf. Goes on with what a run that was killed has left. Says on
/// standard error what looks like a slip, and its progress unless quiet.
/// @return what came out (docs/json.md), null on all ranks but the first; of a dry run, which writes nothing, what a solve takes, with
///         `refused`, the reason, where that does not fit the machine
/// @throw program::UsageError, std::runtime_error  in one line
[[nodiscard]] program::Json solveCase(const Options& options, const solver::Ranks& ranks);

}  // namespace palpate::solve_program
