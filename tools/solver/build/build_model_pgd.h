// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tools/mesh/tet_mesh.h"
#include "tools/modelfile/model_data.h"
#include "tools/solver/build/build_options.h"
#include "tools/solver/build/case_file.h"

namespace palpate::solver {

/// Methods pgd-linear, pgd-explicit, pgd-euler.                                     paper Sections 2 and 3
[[nodiscard]] modelfile::ModelData buildPgd(const Case& c, const mesh::TetMesh& mesh,
                                            const BuildOptions& options, BuildReport& report);

}  // namespace palpate::solver
