// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tools/mesh/tet_mesh.h"
#include "tools/mesh/triangle_surface.h"

namespace palpate::mesh {

/// Fills a closed surface with tetrahedra (Gmsh). With `element_size` 0 it keeps the surface's triangles, and
/// the vertices are nodes 1..V in their order; otherwise it remeshes the surface at that size first.
/// @param surface has passed checkSurface()
/// @param element_size  m; 0 or positive
/// @throw MeshError when Gmsh cannot mesh it
/// Cost seconds for 1e4 triangles. Threads: one at a time (Gmsh is global state).
[[nodiscard]] TetMesh fillSurface(const TriangleSurface& surface, double element_size);

}  // namespace palpate::mesh
