// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "palpate/mesh/tet_mesh.h"
#include "palpate/mesh/triangle_surface.h"

namespace palpate::mesh {

/// Fills a closed surface with tetrahedra (Gmsh). With `element_size` 0 the surface's triangles are kept, and
/// its vertices are nodes 1..V in their order; otherwise the surface is remeshed at that size first.
/// @param surface       one that checkSurface() takes
/// @param element_size  m; 0 or positive
/// @throw MeshError when Gmsh cannot mesh it
/// Cost seconds for 1e4 triangles. Threads: one at a time (Gmsh is global state).
[[nodiscard]] TetMesh fillSurface(const TriangleSurface& surface, double element_size);

}  // namespace palpate::mesh
