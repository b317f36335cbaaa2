// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "palpate/offline/parametric_problem.h"
#include "palpate/offline/separated_solution.h"
#include "palpate/offline/solver_setup.h"
#include "palpate/reproduce/liver_study.h"
#include "touches.h"

namespace palpate::reproduce {

/// Linear PGD of the whole boundary under a load of fixed direction, against the best separation and against
/// linear finite elements at held-out points. Fills results["linear"].
/// @return the last of the tabulated solutions, pairs by energy
offline::ScalarPairs studyLinear(const offline::SolverSetup& setup, const offline::BodyProblem& problem,
                                 const std::vector<Touch>& points, const LiverOptions& options, Output& out,
                                 Json& results);

}  // namespace palpate::reproduce
