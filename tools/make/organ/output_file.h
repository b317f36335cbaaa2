// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "tools/mesh/tet_mesh.h"

namespace palpate::organ {

/// Before the work whose result it takes: the file's ending is one of a format that writeOrgan() writes, .msh or
/// .vtk, and its folder is there and can be written.
/// @throw program::UsageError that names the endings, program::WriteError
void checkOutput(const std::filesystem::path& file);

/// Writes the format that the file's ending says: Gmsh 4.1 (.msh) or legacy VTK (.vtk), which keeps no groups.
/// @param[out] notes  what the format does not keep
/// @throw MeshError, program::WriteError
void writeOrgan(const std::filesystem::path& file, const mesh::TetMesh& mesh,
                const mesh::BoundarySurface& boundary, std::vector<std::string>& notes);

}  // namespace palpate::organ
