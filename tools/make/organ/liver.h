// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tools/mesh/tet_mesh.h"

namespace palpate::organ {

constexpr double kLiverElementSize = 0.0067;  ///< m; gives about 2,200 surface nodes

/// The default organ: a smooth, closed, liver-like body of about 0.22 x 0.13 x 0.12 m. Two ellipsoids joined,
/// a third cut away from below, all creases rounded (docs/design.md, Parts). x points to the organ's left, y to the
/// back, z up.
///   Groups: `fixed`, the tenth of the surface nodes that lies nearest to the rearmost node along the
///   surface; `accessible`, the surface nodes at least 15 mm away from those: where a tool presses on the rim
///   of the clamp the series reaches less than half as far (docs/decisions/three_parts.md).
/// @param element_size  edge length of the tetrahedra, m, in [0.003, 0.02]
/// @throw MeshError when the size is out of range or Gmsh fails
[[nodiscard]] mesh::TetMesh makeLiver(double element_size = kLiverElementSize);

}  // namespace palpate::organ
