// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "tools/mesh/raw_mesh.h"

namespace palpate::mesh {

/// Reads a Medit .mesh file, for readMesh(). @throw MeshError
RawMesh readMeditFile(const std::filesystem::path& path);

}  // namespace palpate::mesh
