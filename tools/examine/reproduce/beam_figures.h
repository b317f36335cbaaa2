// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "tools/examine/reproduce/beam_problem.h"
#include "tools/examine/reproduce/output.h"
#include "tools/program/json.h"
#include "tools/solver/pgd/level_solution.h"

namespace palpate::reproduce {

/// All solutions, unknowns of the free nodes.
struct BeamSolutions {
  std::vector<Eigen::VectorXd> newton;  ///< full load, every position
  std::vector<Eigen::VectorXd> levels;  ///< Newton, load at the tip, levels 0.1 to 1
  Eigen::VectorXd linear;               ///< load at the tip
  solver::LevelSolution ten_term, forward_euler;
  Eigen::VectorXd ten_term_alone, forward_euler_alone;  ///< load at the tip, nothing separated
};
/// Figures 2 to 4, the curves over load and position, and their tables.
void writeFigures(const Beam& beam, const BeamSolutions& solutions, const Json& results, Output& out);

}  // namespace palpate::reproduce
