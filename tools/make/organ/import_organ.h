// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "tools/make/organ/boundary_groups.h"
#include "tools/mesh/element_sizes.h"
#include "tools/mesh/tet_mesh.h"

namespace palpate::organ {

/// How a file becomes an organ.
struct ImportOptions {
  double scale{1};           ///< metres per unit of the file, positive
  mesh::ElementSizes sizes;  ///< of a surface (.stl, .obj) and what fills it; all 0 by default
  std::optional<int> order;  ///< of the elements, 1 or 2; absent: that of the file, 1 of a surface
  FixedRule fixed;
};

/// An organ, and what its user should know about it.
struct ImportedOrgan {
  mesh::TetMesh mesh;
  mesh::BoundarySurface boundary;
  std::vector<std::string> notes;
};

/// Reads, scales, fills (surfaces), checks, groups and raises to quadratic elements. Nodes keep the file's order; numbers are still the
/// file's.
/// @throw MeshError naming the entity
[[nodiscard]] ImportedOrgan importOrgan(const std::filesystem::path& path, const ImportOptions& options);

/// Numbers nodes and tetrahedra 1..N and 1..T in their order, as writeMsh() does.
void renumber(mesh::TetMesh& mesh);

}  // namespace palpate::organ
