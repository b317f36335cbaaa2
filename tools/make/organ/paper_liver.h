// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tools/mesh/tet_mesh.h"

namespace palpate::organ {

constexpr double kPaperLiverElementSize = 0.0067;  ///< m; gives about 2,200 surface nodes

/// The organ of the comparisons with the paper: a smooth, closed, liver-like body of about 0.22 x 0.13 x 0.12 m. Two
/// ellipsoids joined, a third cut away from below, all creases rounded (docs/design.md, Parts). x points to the
/// organ's left, y to the back, z up.
///   Groups: `fixed`, the tenth of the surface nodes that lies nearest to the rearmost node along the surface;
///   `accessible` (setClamp()).
/// @param element_size  edge length of the tetrahedra, m, in [0.003, 0.02]
/// @return linear elements
/// @throw program::UsageError when the size is out of range, MeshError when Gmsh fails
[[nodiscard]] mesh::TetMesh makePaperLiver(double element_size = kPaperLiverElementSize);

}  // namespace palpate::organ
