// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "tools/examine/reproduce/liver_options.h"
#include "tools/examine/reproduce/output.h"
#include "tools/examine/reproduce/touches.h"
#include "tools/mesh/tet_mesh.h"
#include "tools/program/json.h"
#include "tools/solver/build/case_file.h"
#include "tools/solver/build/solver_setup.h"

namespace palpate::reproduce {

/// The organ of the liver study, as its parts share it.
struct LiverStudy {
  const solver::Case& solve;  ///< mesh, material, whole boundary accessible
  const mesh::TetMesh& mesh;
  const solver::SolverSetup& setup;
  const LiverOptions& options;
};

/// u(X, s, f) in n pairs against full Newton, beside the best separation and the three-part model, and the
/// time to evaluate the whole surface. Fills results["modes_table"], ["three_part"], ["evaluation..."].
/// @param touches  points with loads; it reduces the loads to the series' domain, then solves them by Newton
void studyNonlinear(const LiverStudy& study, std::vector<Touch>& touches, Output& out, Json& results);

}  // namespace palpate::reproduce
