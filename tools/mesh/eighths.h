// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "tools/mesh/tet_mesh.h"

namespace palpate::mesh {

/// A part of a mesh at half the edge length.
struct Eighths {
  TetMesh mesh;                      ///< linear elements; neither groups nor regions
  std::vector<std::int32_t> parent;  ///< by tetrahedron: that of the coarse mesh which it lies in
};

/// Each tetrahedron as eight: four at its corners, and the octahedron between divided along its shortest diagonal.
/// @param chosen  tetrahedra of a valid mesh, each once; mid-side nodes are not looked at. Cost O(k log k)
[[nodiscard]] Eighths eighthsOf(const TetMesh& mesh, std::span<const std::int32_t> chosen);

}  // namespace palpate::mesh
