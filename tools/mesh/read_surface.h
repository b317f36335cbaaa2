// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "tools/mesh/triangle_surface.h"

namespace palpate::mesh {

/// Whether readSurface() reads this file: .stl or .obj.
[[nodiscard]] bool isSurfaceFile(const std::filesystem::path& path);

/// Reads the triangles of an .stl (text or binary; corners at the same place become one vertex) or .obj file
/// (polygons are fanned; groups (`g`) and materials (`usemtl`) are kept as groups; normals and textures are skipped, unused
/// vertices dropped).
/// @throw MeshError, one line with the file and the entity
[[nodiscard]] TriangleSurface readSurface(const std::filesystem::path& path);

}  // namespace palpate::mesh
