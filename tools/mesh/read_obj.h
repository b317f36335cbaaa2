// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "tools/mesh/triangle_surface.h"

namespace palpate::mesh {

/// Reads an .obj file, for readSurface(). @throw MeshError
TriangleSurface readObjFile(const std::filesystem::path& path);

}  // namespace palpate::mesh
