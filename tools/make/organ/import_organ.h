// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "tools/make/organ/fill_file.h"
#include "tools/make/organ/import_options.h"
#include "tools/mesh/tet_mesh.h"

namespace palpate::organ {

/// An organ, and what its user should know about it.
struct ImportedOrgan {
  mesh::TetMesh mesh;
  mesh::BoundarySurface boundary;
  std::vector<std::string> notes;
};

/// Reads, scales, repairs and fills (surfaces), checks, groups and raises to quadratic elements. Nodes keep the
/// file's order; numbers are still the file's.
/// @throw MeshError naming the entity, program::UsageError naming the option that does not fit the file
[[nodiscard]] ImportedOrgan importOrgan(const std::filesystem::path& path, const ImportOptions& options);

/// Checks options, then reads as readSolid() does, with the file's name in errors, and tells what filling it would
/// take.
/// @return nothing when the file holds tetrahedra
[[nodiscard]] std::optional<FileSolid> solidOf(const std::filesystem::path& path,
                                               const ImportOptions& options, std::vector<std::string>& notes);

/// Numbers nodes and tetrahedra 1..N and 1..T in their order, as writeMsh() does.
void renumber(mesh::TetMesh& mesh);

}  // namespace palpate::organ
