// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tools/mesh/tet_mesh.h"

namespace palpate::mesh {

/// The same body with ten nodes an element: one more in the middle of each edge, after the corners, numbered on from the
/// largest node number. It belongs to the groups that both ends of its edge belong to; to a group of surface
/// nodes only if it lies on the surface itself. Regions stay.
/// @throw MeshError where the numbers run out
/// @param linear  elements of four nodes. Cost O(T log T). Real-time: no.
[[nodiscard]] TetMesh quadraticOf(const TetMesh& linear);

}  // namespace palpate::mesh
