// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tools/mesh/element_sizes.h"
#include "tools/mesh/tet_mesh.h"
#include "tools/mesh/triangle_surface.h"

namespace palpate::mesh {

/// Fills one solid with tetrahedra (Gmsh): a closed surface, and those of its cavities, which stay empty. With size 0
/// at the surface it keeps the surface's triangles, and the vertices are nodes 1..V in their order; otherwise it
/// remeshes the surface at that size first.
/// @param surface  that of one Solid
/// @throw MeshError when sizes are out of range or Gmsh cannot mesh it
/// Cost seconds for 1e4 triangles. Threads: one at a time (Gmsh is global state).
[[nodiscard]] TetMesh fillSurface(const TriangleSurface& surface, const ElementSizes& sizes);

}  // namespace palpate::mesh
