// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "palpate/mesh/tet_mesh.h"
#include "palpate/offline/solver_setup.h"
#include "palpate/reproduce/liver_study.h"
#include "touches.h"

namespace palpate::reproduce {

/// The organ of the liver study in the hands of its parts.
struct LiverStudy {
  const offline::Case& solve;  ///< mesh, material, whole boundary accessible
  const mesh::TetMesh& mesh;
  const offline::SolverSetup& setup;
  const LiverOptions& options;
};

/// u(X, s, f) in n pairs against full Newton, beside the best separation and the three-part model; then how fast the
/// whole surface is evaluated. Fills results["modes_table"], ["three_part"], ["evaluation..."].
/// @param touches  points with loads; the loads are limited to the series' domain, then solved by Newton
void studyNonlinear(const LiverStudy& study, std::vector<Touch>& touches, Output& out, Json& results);

}  // namespace palpate::reproduce
