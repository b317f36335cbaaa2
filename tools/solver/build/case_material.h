// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "tools/mesh/tet_mesh.h"
#include "tools/modelfile/model_data.h"
#include "tools/solver/build/case_file.h"
#include "tools/solver/fem/fe_model.h"

namespace palpate::solver {

/// The material of a case: where there are regions, the elements outside all of them are the first, "elsewhere".
/// @throw CaseError by file, line and key for a group that is not there, and for regions that overlap
[[nodiscard]] Material materialOf(const Case& c, const mesh::TetMesh& mesh);

/// A spring at each node of the boundary faces that lie in a group whole: stiffness times the node's part of their area,
/// that of its shape function. Clamped nodes have none.
/// @throw CaseError by file, line and key for a group that is not there or has no face
[[nodiscard]] std::vector<Spring> springsOf(const Case& c, const mesh::TetMesh& mesh);

/// Fills in the regions and the springs of a model file.
void storeMaterial(const FeModel& model, modelfile::ModelData& data);

}  // namespace palpate::solver
