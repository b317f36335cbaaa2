// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "tools/mesh/tet_mesh.h"

namespace palpate::mesh {

/// Reads the tetrahedra of a Gmsh .msh (1, 2, 4.0, 4.1; text, 2 and 4.1 also binary), legacy .vtk
/// (unstructured grid, text or binary) or Medit .mesh (text) file, chosen by extension.
///   Nodes keep the file's order; those in no tetrahedron are dropped. Points, lines and triangles count
///   only for groups. A group is the nodes of all elements of a physical group (Medit: reference), whatever
///   their dimension; groups of the same name are one. The tetrahedra of a volume group are a
///   region of its name as well. A group without a name is called by its number, or
///   `point:1`, `curve:1`, `surface:1`, `volume:1` where several dimensions use the number. VTK has no groups; there,
///   nodes and cells are numbered by position from 1. The file is untrusted: counts are checked against its
///   size, indices against their ranges. checkMesh() checks the geometry.
///   Quadratic tetrahedra (10 nodes; not in Medit files) keep the positions of the file: straighten() them.
/// @throw MeshError, one line with the file and the entity
[[nodiscard]] TetMesh readMesh(const std::filesystem::path& path);

}  // namespace palpate::mesh
