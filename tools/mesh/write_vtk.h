// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "tools/mesh/tet_mesh.h"

namespace palpate::mesh {

/// Writes legacy VTK text (version 3.0, unstructured grid) with coordinates in full precision. Each group becomes point
/// data of its name, 1 at its nodes and 0 elsewhere, each region cell data likewise: to look at, for readMesh() reads
/// no groups from VTK. Blanks in names become underscores. The function writes a file beside the target and renames
/// it.
/// @throw program::WriteError
void writeVtk(const std::filesystem::path& path, const TetMesh& mesh);

}  // namespace palpate::mesh
