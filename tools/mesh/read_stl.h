// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "tools/mesh/triangle_surface.h"

namespace palpate::mesh {

/// Reads an .stl file, for readSurface(). @throw MeshError
TriangleSurface readStlFile(const std::filesystem::path& path);

}  // namespace palpate::mesh
