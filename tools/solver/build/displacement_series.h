// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tools/mesh/tet_mesh.h"
#include "tools/modelfile/model_data.h"
#include "tools/solver/build/build_options.h"
#include "tools/solver/build/case_file.h"

namespace palpate::solver {

/// Method series-displacement: the three parts u(X; s, d), f(s, d).                 docs/design.md, Series, Parts
/// @throw CaseError, std::runtime_error
[[nodiscard]] modelfile::ModelData buildDisplacementSeries(const Case& c, const mesh::TetMesh& mesh,
                                                           const BuildOptions& options, BuildReport& report);

}  // namespace palpate::solver
