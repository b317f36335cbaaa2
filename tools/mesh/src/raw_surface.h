// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "palpate/mesh/triangle_surface.h"

namespace palpate::mesh {

/// The readers behind readSurface(), one a format. Each throws MeshError.
TriangleSurface readStlFile(const std::filesystem::path& path);
TriangleSurface readObjFile(const std::filesystem::path& path);

}  // namespace palpate::mesh
