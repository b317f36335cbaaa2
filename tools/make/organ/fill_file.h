// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "tools/make/organ/import_options.h"
#include "tools/make/organ/size_estimate.h"
#include "tools/mesh/surface_solids.h"
#include "tools/mesh/tet_mesh.h"

namespace palpate::organ {

/// A solid of a file.
struct FileSolid {
  mesh::Solid solid;
  mesh::TriangleSurface
      painted;  ///< the file's surface in metres, before any repair, where it has groups; else empty
};

/// Reads a surface (.stl, .obj), scales it, repairs it where asked, and takes the solid that is wanted.
/// @param[out] notes  what its user should know
/// @throw MeshError with all defects, or with all parts when there are several and none is chosen; program::UsageError when
///        the part that is chosen, or a group that is to be held, is not there
[[nodiscard]] FileSolid readSolid(const std::filesystem::path& path, const ImportOptions& options,
                                  std::vector<std::string>& notes);

/// Whether the element size suits a solid; says what filling it takes, and returns it.
/// @param[out] notes  what makes it coarse, or its length odd
/// @throw program::UsageError when the elements would be too many or too large, with the size that would do
SizeEstimate checkSizes(const mesh::Solid& solid, const ImportOptions& options,
                        std::vector<std::string>& notes);

/// Fills a solid after checkSizes().
/// @param[out] notes  volume that got lost, bad elements
/// @throw MeshError when Gmsh fails, with what to try
[[nodiscard]] mesh::TetMesh fill(const mesh::Solid& solid, const ImportOptions& options,
                                 std::vector<std::string>& notes);

}  // namespace palpate::organ
