// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "tools/mesh/tet_mesh.h"

namespace palpate::mesh {

/// Writes Gmsh 4.1 text, nodes and tetrahedra numbered 1..N and 1..T in their order, coordinates in full
/// precision.
///   Physical volume `organ`: all tetrahedra. A region becomes a physical volume of its name; the file lists its
///   tetrahedra together. A node group becomes a physical surface of its name (the faces on the boundary with
///   all nodes in it, to look at) plus a physical point group of the same name (its nodes in none of these
///   faces), so readMesh() returns exactly the same nodes. A group of all nodes becomes a physical volume. The
///   function writes a file beside the target and renames it.
/// @param boundary  boundaryOf(mesh)
/// @throw MeshError when the file cannot be written, or a group name holds a quote or line break
void writeMsh(const std::filesystem::path& path, const TetMesh& mesh, const BoundarySurface& boundary);

}  // namespace palpate::mesh
