// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "tools/examine/reproduce/liver_options.h"
#include "tools/examine/reproduce/output.h"
#include "tools/examine/reproduce/touches.h"
#include "tools/program/json.h"
#include "tools/solver/build/solver_setup.h"
#include "tools/solver/pgd/parametric_problem.h"
#include "tools/solver/pgd/separated_solution.h"

namespace palpate::reproduce {

/// Linear PGD of the whole boundary under a load of fixed direction, against the best separation and against
/// linear finite elements at held-out points. Fills results["linear"].
/// @return the last of the tabulated solutions, pairs by energy
solver::ScalarPairs studyLinear(const solver::SolverSetup& setup, const solver::BodyProblem& problem,
                                const std::vector<Touch>& points, const LiverOptions& options, Output& out,
                                Json& results);

}  // namespace palpate::reproduce
