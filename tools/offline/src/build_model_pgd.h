// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "palpate/offline/build_model.h"

namespace palpate::offline {

/// Methods pgd-linear, pgd-explicit, pgd-euler.                                     paper Sections 2 and 3
[[nodiscard]] modelfile::ModelData buildPgd(const Case& c, const mesh::TetMesh& mesh,
                                            const BuildOptions& options, BuildReport& report);

}  // namespace palpate::offline
