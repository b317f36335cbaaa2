// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <ostream>
#include <string>
#include <vector>

#include "tools/make/organ/import_organ.h"
#include "tools/mesh/tet_mesh.h"
#include "tools/program/json.h"

namespace palpate::organ {

/// A part of the surface.
struct SurfacePart {
  std::size_t nodes{0};
  std::size_t triangles{0};  ///< all of whose nodes are in the part
  double area{0};            ///< of these, m^2
};

/// Where an organ would be held and touched, told before its surface is filled.
struct Preview {
  mesh::TetMesh mesh;  ///< groups `fixed` and `accessible`; without tetrahedra where the file is a surface
  mesh::BoundarySurface boundary;
  SurfacePart held, touchable,
      neither;  ///< neither: cavities, rims between the two, what the file leaves out
  std::vector<std::string> notes;
};

/// Reads, scales and repairs as importOrgan() does, and groups the surface; fills nothing. Of a surface the nodes are
/// its vertices.
/// @throw MeshError, program::UsageError as importOrgan()
[[nodiscard]] Preview previewOrgan(const std::filesystem::path& path, const ImportOptions& options);

/// The surface from its six sides: what is held, what can be touched, and the rest, in three colours, with a legend
/// and a bar of length. One self-contained SVG.
[[nodiscard]] std::string clampPicture(const Preview& preview);

[[nodiscard]] program::Json toJson(const Preview& preview);
void print(std::ostream& out, const Preview& preview);

}  // namespace palpate::organ
