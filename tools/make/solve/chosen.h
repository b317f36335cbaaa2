// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tools/modelfile/model_data.h"
#include "tools/program/json.h"
#include "tools/solver/build/build_options.h"
#include "tools/solver/build/case_file.h"

namespace palpate::solve_program {

/// What the solver chose of a series-displacement model, each as {"value", "why"}: order, force_order, modes, near_radius,
/// mid_edges.                                                                                docs/json.md
[[nodiscard]] program::Json chosenOf(const solver::Case& c, const modelfile::ModelData& data,
                                     const solver::BuildReport& report);

}  // namespace palpate::solve_program
