// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tools/mesh/tet_mesh.h"
#include "tools/mesh/triangle_surface.h"

namespace palpate::organ {

/// Gives the boundary of an organ the groups that its surface had in the file, before it was repaired and remeshed: each
/// triangle of the boundary is in the groups of the file's triangle that is nearest to its middle, and a group has the nodes
/// of its triangles, none where the boundary has no such triangle. Along a border it is exact to one element.
/// @param painted  the file's surface in metres; without groups nothing changes
void addPaintedGroups(const mesh::TriangleSurface& painted, const mesh::BoundarySurface& boundary,
                      mesh::TetMesh& mesh);

}  // namespace palpate::organ
