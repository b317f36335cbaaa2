// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>

#include "tools/mesh/tet_mesh.h"

namespace palpate::mesh {

/// A box [0, size] of equal cells, six tetrahedra per cell, all around the diagonal from the cell's smallest
/// to its largest corner (Kuhn's subdivision): the beam of docs/design.md, Reproduction.
///   Node (i, j, k) has the index i + nx (j + ny k).
/// @param size   edge lengths, m, positive
/// @param nodes  nodes along x, y, z, each at least 2
/// @throw MeshError when a size or a count is out of range
[[nodiscard]] TetMesh makeBox(const Eigen::Vector3d& size, const std::array<int, 3>& nodes);

/// The beam of docs/design.md, Reproduction: 400 x 40 x 40 mm, 21 x 9 x 9 nodes, groups `fixed` (x = 0) and `accessible` (the
/// other surface nodes).
[[nodiscard]] TetMesh makeBeam();

}  // namespace palpate::mesh
