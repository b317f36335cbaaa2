// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "tools/mesh/tet_mesh.h"
#include "tools/solver/build/case_file.h"

namespace palpate::solve_program {

/// What looks like a slip of unit or of mesh size, before minutes are spent on it: E that no organ has, an organ that no tool
/// touches, a contact patch nearly as wide as the organ. One sentence each, with the figures and what they may have meant.
/// @param organ  checked
[[nodiscard]] std::vector<std::string> sizeWarnings(const solver::Case& c, const mesh::TetMesh& organ);

}  // namespace palpate::solve_program
