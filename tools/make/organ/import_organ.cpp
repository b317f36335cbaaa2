// SPDX-License-Identifier: Apache-2.0
#include "tools/make/organ/import_organ.h"

#include <Eigen/Geometry>
#include <cmath>
#include <numeric>

#include "tools/make/organ/odd_length.h"
#include "tools/make/organ/painted_groups.h"
#include "tools/mesh/checks.h"
#include "tools/mesh/mesh_error.h"
#include "tools/mesh/midsides.h"
#include "tools/mesh/quadratic.h"
#include "tools/mesh/read_mesh.h"
#include "tools/mesh/read_surface.h"
#include "tools/mesh/topology.h"
#include "tools/program/exit_code.h"
#include "tools/program/printed.h"

namespace palpate::organ {
namespace {

using mesh::MeshError;
using program::UsageError;

void checkForSurfaces(const std::filesystem::path& path, const ImportOptions& options) {
  if (options.sizes.surface > 0 || options.sizes.isGraded()) {
    throw UsageError("--element-size and --inner-size are for surfaces (.stl, .obj); the tetrahedra of " +
                     path.string() + " are taken as they are");
  }
  if (options.repair) throw UsageError("--repair is for surfaces (.stl, .obj), not for " + path.string());
  if (options.part) throw UsageError("--part is for surfaces (.stl, .obj), not for " + path.string());
}

void checkOptions(const std::filesystem::path& path, const ImportOptions& options) {
  if (!(options.scale > 0) || !std::isfinite(options.scale))
    throw UsageError("--scale must be a positive number");
  program::orUsageError([&] { mesh::checkElementSizes(options.sizes); });
  if (options.order && *options.order != 1 && *options.order != 2)
    throw UsageError("--element-order must be 1 or 2, not " + std::to_string(*options.order));
  if (!mesh::isSurfaceFile(path)) checkForSurfaces(path, options);
}

/// @param[out] painted  as in FileSolid
mesh::TetMesh readScaled(const std::filesystem::path& path, const ImportOptions& options,
                         mesh::TriangleSurface& painted, std::vector<std::string>& notes) {
  if (mesh::isSurfaceFile(path)) {
    FileSolid read = readSolid(path, options, notes);
    painted = std::move(read.painted);
    return fill(read.solid, options, notes);
  }
  mesh::TetMesh volume = mesh::readMesh(path);
  Eigen::AlignedBox3d box;
  for (auto& x : volume.nodes) box.extend(x *= options.scale);
  if (const auto odd = oddLength(box.sizes().maxCoeff(), options.scale)) notes.push_back(*odd);
  return volume;
}

// A material of the whole surface says nothing of its parts.
void noteGroupsNotKept(ImportedOrgan& organ, const FixedRules& rules, const mesh::TriangleSurface& painted) {
  std::string names;
  for (const auto& name : groupsNotKept(organ.mesh, rules)) {
    const auto group = painted.groups.find(name);
    if (group != painted.groups.end() && group->second.size() == painted.triangles.size()) continue;
    names += (names.empty() ? "" : ", ") + name;
  }
  if (!names.empty()) organ.notes.push_back("groups of the file that are not kept: " + names);
}

void noteCurvedEdges(ImportedOrgan& organ) {
  const mesh::CurvedEdges curved = mesh::straighten(organ.mesh);
  if (curved.count == 0) return;
  organ.notes.push_back(
      program::printed("%zu edges were curved; their nodes were moved into the middle, by %.3g mm at most",
                       curved.count, curved.farthest * 1e3));
}

void setOrder(ImportedOrgan& organ, const std::optional<int>& order) {
  if (!order || (*order == 2) == organ.mesh.isQuadratic()) return;
  if (*order == 1) throw UsageError("--element-order 1: the elements of the file are quadratic");
  organ.mesh = mesh::quadraticOf(organ.mesh);
  organ.boundary = mesh::boundaryOf(organ.mesh);
}

ImportedOrgan importChecked(const std::filesystem::path& path, const ImportOptions& options) {
  ImportedOrgan organ;
  mesh::TriangleSurface painted;
  organ.mesh = readScaled(path, options, painted, organ.notes);
  if (mesh::reorientIfAllNegative(organ.mesh)) {
    organ.notes.emplace_back("all tetrahedra had negative volume and were turned over");
  }
  noteCurvedEdges(organ);
  mesh::checkMesh(organ.mesh);
  organ.boundary = mesh::boundaryOf(organ.mesh);
  addPaintedGroups(painted, organ.boundary, organ.mesh);
  noteGroupsNotKept(organ, options.fixed, painted);
  setBoundaryGroups(organ.mesh, organ.boundary, options.fixed);
  if (!organ.mesh.groups.contains("fixed")) {
    organ.notes.emplace_back("nothing is fixed: name a side, a group or a box with --fixed");
  }
  setOrder(organ, options.order);
  return organ;
}

// The readers name the file already, the checks do not.
template <class Work>
auto withItsName(const std::filesystem::path& path, const Work& work) {
  try {
    return work();
  } catch (const MeshError& error) {
    const std::string message = error.what();
    if (message.starts_with(path.string())) throw;
    throw MeshError(path.string() + ": " + message);
  }
}

}  // namespace

ImportedOrgan importOrgan(const std::filesystem::path& path, const ImportOptions& options) {
  checkOptions(path, options);
  return withItsName(path, [&] { return importChecked(path, options); });
}

std::optional<FileSolid> solidOf(const std::filesystem::path& path, const ImportOptions& options,
                                 std::vector<std::string>& notes) {
  if (!mesh::isSurfaceFile(path)) return std::nullopt;
  checkOptions(path, options);
  return withItsName(path, [&]() -> std::optional<FileSolid> {
    FileSolid read = readSolid(path, options, notes);
    (void)checkSizes(read.solid, options, notes);
    return read;
  });
}

void renumber(mesh::TetMesh& mesh) {
  std::iota(mesh.node_tags.begin(), mesh.node_tags.end(), 1);
  std::iota(mesh.tetrahedron_tags.begin(), mesh.tetrahedron_tags.end(), 1);
}

}  // namespace palpate::organ
