// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "core/data/datasets.h"
#include "core/data/model_view.h"
#include "core/data/sha256.h"

// What a model consists of, each part once and in one order: the digest and the writer walk these lists.
namespace palpate {

/// Of the model file: what it holds and how.
inline constexpr int kModelVersion = 6;

/// Attributes that answers depend on, as a file has them. visit(name, value) gets texts, doubles, int32s and
/// arrays of doubles. @param[in] a  force_order as in the file, not 0
template <class Visit>
void forEachAttribute(const ModelAttributes& a, Visit&& visit) {
  visit("format", std::string("palpate-model"));
  visit("version", std::int32_t{kModelVersion});
  visit("parameters", std::string(toString(a.parameters)));
  visit("law", a.law);
  visit("E", a.E);
  visit("nu", a.nu);
  visit("patch_radius", a.patch_radius);
  visit("near_radius", a.near_radius);
  visit("reference_displacement", a.reference_displacement);
  visit("rounded_triangles", std::int32_t{a.rounded_triangles});
  if (a.parameters == Parameters::kLevel) {
    visit("load_direction", a.load_direction);
    visit("load", a.load);
    return;
  }
  visit("order", std::int32_t{a.order});
  visit("force_order", std::int32_t{a.force_order});
  if (a.parameters == Parameters::kForce) visit("reference_force", a.reference_force);
}

/// Datasets that a file of this kind has. visit(Dataset<T>, std::span<const T>), and of fields visit(Dataset<std::int16_t>,
/// WholeNumbers).
template <class Visit>
void forEachDataset(const ModelAttributes& a, const ModelView& v, Visit&& visit) {
  visit(dataset::kSurfacePositions, v.surface_positions);
  visit(dataset::kSurfaceTriangles, v.surface_triangles);
  visit(dataset::kSurfaceMeshTag, v.surface_mesh_tag);
  visit(dataset::kPositionOfNode, v.position_of_node);
  visit(dataset::kContactNode, v.contact_node);
  visit(dataset::kContactAccessible, v.contact_accessible);
  visit(dataset::kContactTriangles, v.contact_triangles);
  visit(dataset::kContactDomainRadius, v.contact_domain_radius);
  if (a.parameters == Parameters::kDisplacement) {
    visit(dataset::kContactForce, v.contact_force);
    visit(dataset::kContactStiffness, v.contact_stiffness);
    visit(dataset::kContactSeriesRadius, v.contact_series_radius);
  }
  if (a.parameters != Parameters::kDisplacement) visit(dataset::kContactDisplacement, v.contact_displacement);
  if (a.parameters == Parameters::kLevel) visit(dataset::kLevelsZ, v.levels_Z);
  visit(dataset::kModesX, v.modes_X);
  visit(dataset::kModesXScale, v.modes_X_scale);
  visit(dataset::kModesY, v.modes_Y);
  visit(dataset::kModesYScale, v.modes_Y_scale);
  visit(dataset::kNearOffset, v.near_offset);
  visit(dataset::kNearNode, v.near_node);
  visit(dataset::kNearField, v.near_field);
  visit(dataset::kNearScale, v.near_scale);
  if (a.parameters == Parameters::kDisplacement) {
    visit(dataset::kGreenNode, v.green_node);
    visit(dataset::kGreenY, v.green_Y);
    visit(dataset::kGreenYScale, v.green_Y_scale);
    visit(dataset::kGreenOffset, v.green_offset);
    visit(dataset::kGreenNearNode, v.green_near_node);
    visit(dataset::kGreenNear, v.green_near);
    visit(dataset::kGreenNearScale, v.green_near_scale);
  }
  if (!v.edge_offset.empty()) {
    visit(dataset::kEdgeOffset, v.edge_offset);
    visit(dataset::kEdgeNode, v.edge_node);
    visit(dataset::kEdgeField, v.edge_field);
    visit(dataset::kEdgeScale, v.edge_scale);
  }
  visit(dataset::kMeshNodes, v.mesh_nodes);
  visit(dataset::kMeshTetrahedra, v.mesh_tetrahedra);
  if (!v.mesh_midsides.empty()) visit(dataset::kMeshMidsides, v.mesh_midsides);
  visit(dataset::kMeshNodeTag, v.mesh_node_tag);
  visit(dataset::kMeshTetrahedronTag, v.mesh_tetrahedron_tag);
  visit(dataset::kMeshFixed, v.mesh_fixed);
  visit(dataset::kMeshSurfaceNode, v.mesh_surface_node);
  if (!v.region_name.empty()) {
    visit(dataset::kElementRegion, v.mesh_element_region);
    visit(dataset::kRegionName, v.region_name);
    visit(dataset::kRegionE, v.region_E);
    visit(dataset::kRegionNu, v.region_nu);
    visit(dataset::kRegionLaw, v.region_law);
  }
  if (v.spring_node.empty()) return;
  visit(dataset::kSpringNode, v.spring_node);
  visit(dataset::kSpringStiffness, v.spring_stiffness);
}

/// Lengths by the symbols of datasets.h.
using LengthTable = std::map<std::string_view, std::uint64_t>;
[[nodiscard]] LengthTable lengthsOf(const ModelAttributes& attributes, const ModelView& view);

/// @param[in] shape  of a Dataset
[[nodiscard]] std::vector<std::uint64_t> shapeOf(const std::array<const char*, 4>& shape,
                                                 const LengthTable& lengths);

/// Name, type, shape and bytes of all attributes and datasets above.           docs/model_file.md, Digest
/// The provenance is not in it: the same organ solved twice is the same model. O(bytes).
[[nodiscard]] Digest contentDigest(const ModelAttributes& attributes, const ModelView& view);

}  // namespace palpate
