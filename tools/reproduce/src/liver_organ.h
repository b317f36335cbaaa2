// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "palpate/offline/parametric_problem.h"
#include "palpate/offline/solver_setup.h"

namespace palpate::reproduce {

/// The paper's liver: E = 160 kPa, nu = 0.48, every free node of the boundary accessible.               paper 4.3
[[nodiscard]] offline::Case wholeBoundary(const std::filesystem::path& mesh);

/// A load downward at every contact position, over its patch; weights are the nodes' areas.
/// @param[in]  travel  m, median of |d| over the positions in linear theory  @param[out] load N, that gives
/// this median
[[nodiscard]] offline::BodyProblem downwardProblem(const offline::SolverSetup& setup, double travel,
                                                   double& load);

}  // namespace palpate::reproduce
