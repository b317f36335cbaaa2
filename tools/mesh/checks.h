// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "tools/mesh/tet_mesh.h"

namespace palpate::mesh {

/// Inverts every tetrahedron when all of them have negative volume, a convention of some exporters.
/// @return true if it did; it leaves a mesh with both signs unchanged, and checkMesh() refuses that.
bool reorientIfAllNegative(TetMesh& mesh);

/// Refuses meshes that the solver cannot use, in this order: empty mesh, wrong array sizes or indices out of
/// range, non-finite coordinates, unreferenced nodes, repeated corners, flat tetrahedra (volume < 1e-9 of the
/// longest edge cubed), inverted ones, duplicates, mid-side nodes (checkMidsides()), faces shared by more than two tetrahedra or by two on the
/// same side, disconnected parts, boundary edges in other than two triangles, boundary vertices whose
/// triangles are not one fan.
/// @throw MeshError naming the entity by its number in the mesh file (node_tags, tetrahedron_tags)
/// Cost O(T log T). Real-time: no.
void checkMesh(const TetMesh& mesh);

/// Refuses a group of clamped nodes that allows a rigid motion of the organ: fewer than three nodes, or nodes
/// on one line. The group's nodes must be indices of the mesh.
/// @throw MeshError naming the group and its number of nodes, or the missing group
/// Cost O(nodes of the group). Real-time: no.
void checkHeld(const TetMesh& mesh, const std::string& group);

}  // namespace palpate::mesh
