// SPDX-License-Identifier: Apache-2.0
#include "tools/make/organ/import_organ.h"

#include <cmath>
#include <cstdio>
#include <numeric>

#include "tools/mesh/checks.h"
#include "tools/mesh/fill_surface.h"
#include "tools/mesh/mesh_error.h"
#include "tools/mesh/midsides.h"
#include "tools/mesh/quadratic.h"
#include "tools/mesh/read_mesh.h"
#include "tools/mesh/read_surface.h"
#include "tools/mesh/topology.h"

namespace palpate::organ {
namespace {

using mesh::MeshError;

void checkOptions(const std::filesystem::path& path, const ImportOptions& options) {
  if (!(options.scale > 0) || !std::isfinite(options.scale))
    throw MeshError("--scale must be a positive number");
  mesh::checkElementSizes(options.sizes);
  const bool is_sized = options.sizes.surface > 0 || options.sizes.isGraded();
  if (is_sized && !mesh::isSurfaceFile(path)) {
    throw MeshError("--element-size and --inner-size are for surfaces (.stl, .obj); the tetrahedra of " +
                    path.string() + " are taken as they are");
  }
  if (options.order && *options.order != 1 && *options.order != 2)
    throw MeshError("--element-order must be 1 or 2, not " + std::to_string(*options.order));
}

mesh::TetMesh readScaled(const std::filesystem::path& path, const ImportOptions& options) {
  if (!mesh::isSurfaceFile(path)) {
    mesh::TetMesh volume = mesh::readMesh(path);
    for (auto& x : volume.nodes) x *= options.scale;
    return volume;
  }
  mesh::TriangleSurface surface = mesh::readSurface(path);
  for (auto& x : surface.vertices) x *= options.scale;
  mesh::checkSurface(surface);
  return mesh::fillSurface(surface, options.sizes);
}

void noteGroupsNotKept(ImportedOrgan& organ, const FixedRule& rule) {
  std::string names;
  for (const auto& name : groupsNotKept(organ.mesh, rule)) names += (names.empty() ? "" : ", ") + name;
  if (!names.empty()) organ.notes.push_back("groups of the file that are not kept: " + names);
}

void noteCurvedEdges(ImportedOrgan& organ) {
  const mesh::CurvedEdges curved = mesh::straighten(organ.mesh);
  if (curved.count == 0) return;
  char text[120];
  std::snprintf(text, sizeof text,
                "%zu edges were curved; their nodes were moved into the middle, by %.3g mm at most",
                curved.count, curved.farthest * 1e3);
  organ.notes.emplace_back(text);
}

void setOrder(ImportedOrgan& organ, const std::optional<int>& order) {
  if (!order || (*order == 2) == organ.mesh.isQuadratic()) return;
  if (*order == 1) throw MeshError("--element-order 1: the elements of the file are quadratic");
  organ.mesh = mesh::quadraticOf(organ.mesh);
  organ.boundary = mesh::boundaryOf(organ.mesh);
}

ImportedOrgan importChecked(const std::filesystem::path& path, const ImportOptions& options) {
  ImportedOrgan organ{readScaled(path, options), {}, {}};
  if (mesh::reorientIfAllNegative(organ.mesh)) {
    organ.notes.emplace_back("all tetrahedra had negative volume and were turned over");
  }
  noteCurvedEdges(organ);
  mesh::checkMesh(organ.mesh);
  organ.boundary = mesh::boundaryOf(organ.mesh);
  noteGroupsNotKept(organ, options.fixed);
  setBoundaryGroups(organ.mesh, organ.boundary, options.fixed);
  if (!organ.mesh.groups.contains("fixed")) {
    organ.notes.emplace_back("nothing is fixed: name a group, a height or a box with --fixed");
  }
  setOrder(organ, options.order);
  return organ;
}

}  // namespace

ImportedOrgan importOrgan(const std::filesystem::path& path, const ImportOptions& options) {
  checkOptions(path, options);
  try {
    return importChecked(path, options);
  } catch (const MeshError& error) {
    // The readers name the file already, the checks do not.
    const std::string message = error.what();
    if (message.starts_with(path.string()) || message.starts_with("--")) throw;
    throw MeshError(path.string() + ": " + message);
  }
}

void renumber(mesh::TetMesh& mesh) {
  std::iota(mesh.node_tags.begin(), mesh.node_tags.end(), 1);
  std::iota(mesh.tetrahedron_tags.begin(), mesh.tetrahedron_tags.end(), 1);
}

}  // namespace palpate::organ
