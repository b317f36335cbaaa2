// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "tools/mesh/byte_reader.h"
#include "tools/mesh/raw_mesh.h"

namespace palpate::mesh {

/// The first section of a .msh file.
struct MshFormat {
  int major{0};  ///< 1, 2 or 4
  int minor{0};
  bool binary{false};
};

/// Dimension and number of nodes of a Gmsh element type.
struct MshElementType {
  int dimension;
  int nodes;
};

/// Looks up the type of element `tag`. Refuses volume elements that are not tetrahedra of 4 or 10 nodes:
/// without them the organ would have a hole.
MshElementType mshElementType(const ByteReader& in, std::int64_t type, std::int64_t tag);

/// Reads the nodes of one element; keeps it if it is a tetrahedron, and adds its nodes to its physical
/// groups.
void readMshElement(ByteReader& in, RawMesh& mesh, bool wide, std::int64_t tag, const MshElementType& type,
                    const std::vector<std::int64_t>& groups);

}  // namespace palpate::mesh
