// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "tools/mesh/raw_mesh.h"

namespace palpate::mesh {

/// Reads a legacy .vtk file, for readMesh(). @throw MeshError
RawMesh readVtkFile(const std::filesystem::path& path);

}  // namespace palpate::mesh
