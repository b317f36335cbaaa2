// SPDX-License-Identifier: Apache-2.0
#include "tools/solver/build/solver_setup.h"

#include <algorithm>
#include <cstdio>
#include <numeric>
#include <span>
#include <stdexcept>
#include <string>

#include "core/base/index.h"
#include "tools/mesh/topology.h"
#include "tools/solver/build/case_material.h"

namespace palpate::solver {

namespace {

const std::vector<std::int32_t>& groupOf(const Case& c, const mesh::TetMesh& mesh, const std::string& name) {
  const auto found = mesh.groups.find(name);
  if (found != mesh.groups.end() && !found->second.empty()) return found->second;
  std::string list;
  for (const auto& [group, nodes] : mesh.groups) list += (list.empty() ? "" : ", ") + group;
  throw CaseError(c.mesh.string() + ": no group \"" + name +
                  "\" (there are: " + (list.empty() ? "none" : list) + ")");
}

/// The clamped nodes. Springs may hold the organ instead, where the case names no group of its own.
std::vector<std::int32_t> fixedOf(const Case& c, const mesh::TetMesh& mesh) {
  if (!c.springs.empty() && c.fixed == Case{}.fixed && mesh.groups.count(c.fixed) == 0) return {};
  return groupOf(c, mesh, c.fixed);
}

std::vector<bool> accessibleNodes(const Case& c, const mesh::TetMesh& mesh, const FeModel& model,
                                  const PatchSurface& surface) {
  std::vector<bool> by_volume_node(mesh.nodes.size(), !c.accessible.has_value());
  if (c.accessible)
    for (const std::int32_t node : groupOf(c, mesh, *c.accessible)) by_volume_node[index(node)] = true;
  std::vector<bool> accessible = surface.corners();
  for (std::size_t i = 0; i < surface.nodes.size(); ++i)
    accessible[i] =
        accessible[i] && by_volume_node[index(surface.nodes[i])] && model.isFree(surface.nodes[i]);
  if (std::none_of(accessible.begin(), accessible.end(), [](bool yes) { return yes; }))
    throw CaseError(c.mesh.string() + ": no accessible node on the free surface");
  return accessible;
}

/// Free nodes in the order of the mesh, then the clamped nodes, which never move.
void clampedLast(const FeModel& model, mesh::BoundarySurface& boundary) {
  std::vector<int> order(boundary.nodes.size()), place(boundary.nodes.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_partition(order.begin(), order.end(),
                        [&](int node) { return model.isFree(boundary.nodes[index(node)]); });
  const std::vector<std::int32_t> nodes = boundary.nodes;
  for (std::size_t i = 0; i < order.size(); ++i) {
    boundary.nodes[i] = nodes[index(order[i])];
    place[index(order[i])] = static_cast<int>(i);
  }
  for (auto* list : {&boundary.triangles, &boundary.faces})
    for (auto& triangle : *list)
      for (std::int32_t& node : triangle) node = place[index(node)];
}

PatchSurface surfaceOf(const FeModel& model, const mesh::TetMesh& mesh) {
  mesh::BoundarySurface boundary = mesh::boundaryOf(mesh);
  clampedLast(model, boundary);
  return {model, std::move(boundary.nodes), std::move(boundary.triangles), std::move(boundary.faces)};
}

std::string text(double x) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%.4g", x);
  return buffer;
}

/// The patch of a nodal load: so narrow that it holds one node.
double nodalRadius(const PatchSurface& surface) {
  return 1e-6 * surface.medianEdge();
}

/// The given or default a. A patch that reaches no neighbour is a point load; one as wide as the organ is no
/// contact.
double patchRadius(const Case& c, const PatchSurface& surface) {
  const bool quadratic = surface.faces.size() < surface.triangles.size();
  if (c.nodalLoad() && quadratic)
    throw CaseError(c.mesh.string() +
                    ": load.node needs linear elements: a pressure loads no corner of quadratic ones");
  if (c.nodalLoad()) return nodalRadius(surface);
  const double edge = surface.medianEdge();
  const double a = c.patch_radius.value_or(usualPatchRadius(edge, quadratic));
  Vec3 low = surface.positions.front(), high = low;
  for (const Vec3& x : surface.positions) {
    low = low.cwiseMin(x);
    high = high.cwiseMax(x);
  }
  const double widest = 0.5 * (high - low).minCoeff();
  if (!(a > edge / 3.0) || a > std::max(widest, 1.3 * edge))
    throw CaseError(c.mesh.string() + ": model.patch_radius = " + text(a) +
                    " m does not fit; the median surface edge is " + text(edge) +
                    " m, half the smallest extent " + text(widest) + " m");
  return a;
}

void storeSurface(const SolverSetup& setup, const mesh::TetMesh& mesh, modelfile::ModelData& data) {
  data.position_of_node.assign(setup.surface.nodes.size(), -1);
  for (std::size_t p = 0; p < setup.positions.nodes.size(); ++p)
    data.position_of_node[index(setup.positions.nodes[p])] = static_cast<std::int32_t>(p);
  data.contact_node = setup.positions.nodes;
  data.contact_accessible = setup.positions.accessible;
  for (const auto& t : setup.surface.triangles)
    data.surface_triangles.insert(data.surface_triangles.end(), t.begin(), t.end());
  for (const auto& t : setup.surface.faces)
    data.contact_triangles.insert(data.contact_triangles.end(), t.begin(), t.end());
  for (std::size_t i = 0; i < setup.surface.nodes.size(); ++i) {
    data.surface_mesh_tag.push_back(mesh.node_tags[index(setup.surface.nodes[i])]);
    for (int c = 0; c < 3; ++c) data.surface_positions.push_back(setup.surface.positions[i][c]);
  }
}

void storeMesh(const SolverSetup& setup, const mesh::TetMesh& mesh, modelfile::ModelData& data) {
  for (const Vec3& X : mesh.nodes) data.mesh_nodes.insert(data.mesh_nodes.end(), X.data(), X.data() + 3);
  for (const auto& t : mesh.tetrahedra)
    data.mesh_tetrahedra.insert(data.mesh_tetrahedra.end(), t.begin(), t.end());
  for (const auto& t : mesh.midsides) data.mesh_midsides.insert(data.mesh_midsides.end(), t.begin(), t.end());
  data.mesh_node_tag = mesh.node_tags;
  data.mesh_tetrahedron_tag = mesh.tetrahedron_tags;
  data.mesh_fixed = setup.model.fixedNodes();
  data.mesh_surface_node = setup.surface.nodes;
}

ContactPatches patchesOf(const FeModel& model, const PatchSurface& surface, double patch_radius,
                         std::span<const std::int32_t> centres) {
  try {
    return {surface.graph, freeNodes(model, surface), patch_radius, centres};
  } catch (const std::invalid_argument& error) {
    throw CaseError(std::string("model.") + error.what());
  }
}

}  // namespace

double usualPatchRadius(double median_edge, bool quadratic) {
  return (quadratic ? 0.8 : 1.3) * median_edge;
}

ContactPositions contactPositions(const FeModel& model, const PatchSurface& surface,
                                  const std::vector<bool>& accessible, double patch_radius,
                                  const mesh::TetMesh& mesh) {
  // A helper needs enough of its patch on free nodes to have an answer of its own.
  constexpr double kEnough = 0.05;
  std::vector<bool> wanted = accessible;
  for (const auto& t : surface.faces)
    if (std::any_of(t.begin(), t.end(), [&](std::int32_t node) { return accessible[index(node)]; }))
      for (const std::int32_t node : t) wanted[index(node)] = true;
  std::vector<std::int32_t> centres;
  for (std::size_t node = 0; node < wanted.size(); ++node)
    if (wanted[node]) centres.push_back(static_cast<std::int32_t>(node));
  const ContactPatches patches = patchesOf(model, surface, patch_radius, centres);
  PatchNodes nodes = patches.room();
  ContactPositions positions;
  for (const bool helpers : {false, true}) {
    for (std::size_t node = 0; node < surface.nodes.size(); ++node) {
      if (!wanted[node] || accessible[node] == helpers) continue;
      patches.at(surface.atNode(static_cast<int>(node)), false, nodes);
      Patch patch = patchOf(surface, nodes);
      if (patch.nodes.empty() && !helpers)
        throw CaseError("node " + std::to_string(mesh.node_tags[index(surface.nodes[node])]) +
                        ": its contact patch lies on clamped nodes only");
      if (helpers && patch.free_share < kEnough) continue;
      positions.nodes.push_back(static_cast<std::int32_t>(node));
      positions.accessible.push_back(helpers ? 0 : 1);
      positions.patches.push_back(std::move(patch));
    }
  }
  return positions;
}

SolverSetup::SolverSetup(const Case& c, const mesh::TetMesh& mesh)
    : model(mesh.nodes, {mesh.tetrahedra, mesh.midsides}, fixedOf(c, mesh), materialOf(c, mesh),
            springsOf(c, mesh)),
      surface(surfaceOf(model, mesh)),
      patch_radius(patchRadius(c, surface)),
      positions(
          contactPositions(model, surface, accessibleNodes(c, mesh, model, surface), patch_radius, mesh)) {}

std::vector<double> SolverSetup::positionAreas() const {
  std::vector<double> areas;
  for (const std::int32_t node : positions.nodes) areas.push_back(surface.areas[index(node)]);
  return areas;
}

void storeOrgan(const SolverSetup& setup, const mesh::TetMesh& mesh, modelfile::ModelData& data) {
  storeSurface(setup, mesh, data);
  storeMesh(setup, mesh, data);
  storeMaterial(setup.model, data);
}

}  // namespace palpate::solver
