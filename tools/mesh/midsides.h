// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "tools/mesh/tet_mesh.h"

namespace palpate::mesh {

/// How far mid-side nodes were from the middle of their edge.
struct CurvedEdges {
  std::size_t count{0};  ///< of edges whose node is off by more than rounding (1e-4 of the edge's length)
  double farthest{0};    ///< m
};

/// Moves every mid-side node into the middle of its edge: a TetMesh has straight edges.
/// @param mesh  indices in range. Cost O(T log T). Real-time: no.
CurvedEdges straighten(TetMesh& mesh);

/// Refuses mid-side nodes that are a corner too, or belong to two edges; edges with different nodes in
/// neighbouring tetrahedra; nodes off the middle by more than rounding.
/// @param mesh  indices in range
/// @throw MeshError naming node and tetrahedron. Cost O(T log T). Real-time: no.
void checkMidsides(const TetMesh& mesh);

}  // namespace palpate::mesh
