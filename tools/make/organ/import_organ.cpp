// SPDX-License-Identifier: Apache-2.0
#include "tools/make/organ/import_organ.h"

#include <Eigen/Geometry>
#include <cmath>
#include <cstdio>
#include <numeric>

#include "tools/make/organ/fill_file.h"
#include "tools/make/organ/odd_length.h"
#include "tools/mesh/checks.h"
#include "tools/mesh/mesh_error.h"
#include "tools/mesh/midsides.h"
#include "tools/mesh/quadratic.h"
#include "tools/mesh/read_mesh.h"
#include "tools/mesh/read_surface.h"
#include "tools/mesh/topology.h"

namespace palpate::organ {
namespace {

using mesh::MeshError;

void checkForSurfaces(const std::filesystem::path& path, const ImportOptions& options) {
  if (options.sizes.surface > 0 || options.sizes.isGraded()) {
    throw MeshError("--element-size and --inner-size are for surfaces (.stl, .obj); the tetrahedra of " +
                    path.string() + " are taken as they are");
  }
  if (options.repair) throw MeshError("--repair is for surfaces (.stl, .obj), not for " + path.string());
  if (options.part) throw MeshError("--part is for surfaces (.stl, .obj), not for " + path.string());
}

void checkForMeshes(const std::filesystem::path& path, const ImportOptions& options) {
  for (const FixedRule& rule : options.fixed) {
    if (rule.kind != FixedRule::Kind::kGroup) continue;
    throw MeshError("--fixed " + rule.text + ": there is no such group; surfaces (.stl, .obj) such as " +
                    path.string() + " have none");
  }
}

void checkOptions(const std::filesystem::path& path, const ImportOptions& options) {
  if (!(options.scale > 0) || !std::isfinite(options.scale))
    throw MeshError("--scale must be a positive number");
  mesh::checkElementSizes(options.sizes);
  if (options.order && *options.order != 1 && *options.order != 2)
    throw MeshError("--element-order must be 1 or 2, not " + std::to_string(*options.order));
  mesh::isSurfaceFile(path) ? checkForMeshes(path, options) : checkForSurfaces(path, options);
}

mesh::TetMesh readScaled(const std::filesystem::path& path, const ImportOptions& options,
                         std::vector<std::string>& notes) {
  if (mesh::isSurfaceFile(path)) return fill(readSolid(path, options, notes), options, notes);
  mesh::TetMesh volume = mesh::readMesh(path);
  Eigen::AlignedBox3d box;
  for (auto& x : volume.nodes) box.extend(x *= options.scale);
  if (const auto odd = oddLength(box.sizes().maxCoeff(), options.scale)) notes.push_back(*odd);
  return volume;
}

void noteGroupsNotKept(ImportedOrgan& organ, const FixedRules& rules) {
  std::string names;
  for (const auto& name : groupsNotKept(organ.mesh, rules)) names += (names.empty() ? "" : ", ") + name;
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
  ImportedOrgan organ;
  organ.mesh = readScaled(path, options, organ.notes);
  if (mesh::reorientIfAllNegative(organ.mesh)) {
    organ.notes.emplace_back("all tetrahedra had negative volume and were turned over");
  }
  noteCurvedEdges(organ);
  mesh::checkMesh(organ.mesh);
  organ.boundary = mesh::boundaryOf(organ.mesh);
  noteGroupsNotKept(organ, options.fixed);
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
    if (message.starts_with(path.string()) || message.starts_with("--")) throw;
    throw MeshError(path.string() + ": " + message);
  }
}

}  // namespace

ImportedOrgan importOrgan(const std::filesystem::path& path, const ImportOptions& options) {
  checkOptions(path, options);
  return withItsName(path, [&] { return importChecked(path, options); });
}

std::optional<mesh::Solid> solidOf(const std::filesystem::path& path, const ImportOptions& options,
                                   std::vector<std::string>& notes) {
  if (!mesh::isSurfaceFile(path)) return std::nullopt;
  checkOptions(path, options);
  return withItsName(path, [&]() -> std::optional<mesh::Solid> {
    mesh::Solid solid = readSolid(path, options, notes);
    checkSizes(solid, options, notes);
    return solid;
  });
}

void renumber(mesh::TetMesh& mesh) {
  std::iota(mesh.node_tags.begin(), mesh.node_tags.end(), 1);
  std::iota(mesh.tetrahedron_tags.begin(), mesh.tetrahedron_tags.end(), 1);
}

}  // namespace palpate::organ
