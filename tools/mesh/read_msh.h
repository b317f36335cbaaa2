// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "tools/mesh/raw_mesh.h"

namespace palpate::mesh {

/// Reads a Gmsh .msh file, for readMesh(). @throw MeshError
RawMesh readMshFile(const std::filesystem::path& path);

}  // namespace palpate::mesh
