// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "tools/mesh/tet_mesh.h"

namespace palpate::mesh {

/// Corners of the four faces of a tetrahedron of positive volume, counter-clockwise from outside. Face i lies
/// opposite corner i.
inline constexpr std::array<std::array<int, 3>, 4> kTetFaces{{{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};

/// One face of one tetrahedron; `key` holds its nodes in ascending order, so two tetrahedra that share a face
/// have the same key for it.
struct TetFace {
  std::array<std::int32_t, 3> key;
  std::int32_t tetrahedron;
  std::int32_t face;  ///< row of kTetFaces
};

/// All 4 T faces, sorted by key, then by tetrahedron: equal faces are neighbours. Cost O(T log T).
[[nodiscard]] std::vector<TetFace> sortedFaces(const TetMesh& mesh);

/// The faces that belong to one tetrahedron only, oriented outward, in ascending order of their corners.
///   checkMesh() checks whether the result is a closed manifold; this function does not.
/// @param mesh  tetrahedra of positive volume (else their faces point inward)
/// Cost O(T log T). Real-time: no.
[[nodiscard]] BoundarySurface boundaryOf(const TetMesh& mesh);

/// Six times the signed volume of a tetrahedron is (b-a) . ((c-a) x (d-a)); this is the volume, m^3.
[[nodiscard]] double signedVolume(const TetMesh& mesh, std::size_t tetrahedron);

}  // namespace palpate::mesh
