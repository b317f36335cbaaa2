// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tools/solver/build/build_model.h"

namespace palpate::solver {

/// Methods pgd-linear, pgd-explicit, pgd-euler.                                     paper Sections 2 and 3
[[nodiscard]] modelfile::ModelData buildPgd(const Case& c, const mesh::TetMesh& mesh,
                                            const BuildOptions& options, BuildReport& report);

}  // namespace palpate::solver
