// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "tools/solver/build/case_file.h"
#include "tools/solver/build/solver_setup.h"
#include "tools/solver/pgd/parametric_problem.h"

namespace palpate::reproduce {

/// The paper's liver: E = 160 kPa, nu = 0.48, every free node of the boundary accessible.               paper 4.3
[[nodiscard]] solver::Case wholeBoundary(const std::filesystem::path& mesh);

/// A load downward at every contact position, over its patch; weights are the nodes' areas.
/// @param[in]  travel  m, median of |d| over the positions in linear theory  @param[out] load N, that gives
/// this median
[[nodiscard]] solver::BodyProblem downwardProblem(const solver::SolverSetup& setup, double travel,
                                                  double& load);

}  // namespace palpate::reproduce
