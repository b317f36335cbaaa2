// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "tools/mesh/tet_mesh.h"

namespace palpate::organ {

/// Sets the groups `fixed` and `accessible`: the surface nodes at least 15 mm away from what is fixed. Where a tool
/// presses on the rim of the clamp the series reaches less than half as far (docs/decisions/three_parts.md).
/// @param fixed  surface nodes, in any order. Cost O(surface nodes x fixed nodes).
void setClamp(mesh::TetMesh& mesh, const mesh::BoundarySurface& boundary, std::vector<std::int32_t> fixed);

}  // namespace palpate::organ
