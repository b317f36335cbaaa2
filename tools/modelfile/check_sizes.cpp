// SPDX-License-Identifier: Apache-2.0
#include "tools/modelfile/check_sizes.h"

#include <algorithm>
#include <cstddef>
#include <string>

#include "core/base/multi_index.h"
#include "core/data/datasets.h"

namespace palpate::modelfile {

namespace {

void expectSize(const std::string& dataset, std::size_t found, std::size_t expected) {
  if (found != expected)
    throw ModelFileError(dataset + " has " + std::to_string(found) + " numbers, expected " +
                         std::to_string(expected));
}

void expectTuples(const std::string& dataset, std::size_t found, std::size_t width) {
  if (found % width != 0)
    throw ModelFileError(dataset + " has " + std::to_string(found) + " numbers, expected a multiple of " +
                         std::to_string(width));
}

std::size_t coefficients(const char* name, int order, int most) {
  if (order < 1 || order > most)
    throw ModelFileError(std::string(name) + " is " + std::to_string(order) + ", expected 1 to " +
                         std::to_string(most));
  return static_cast<std::size_t>(MonomialBasis::size(order));
}

void checkSurface(const ModelData& d, std::size_t Ns) {
  expectSize(dataset::kSurfacePositions.name(), d.surface_positions.size(), 3 * Ns);
  expectTuples(dataset::kSurfaceTriangles.name(), d.surface_triangles.size(), 3);
  expectSize(dataset::kPositionOfNode.name(), d.position_of_node.size(), Ns);
  expectSize(dataset::kMeshSurfaceNode.name(), d.mesh_surface_node.size(), Ns);
}

void checkContact(const ModelData& d, std::size_t M, std::size_t C) {
  expectSize(dataset::kContactAccessible.name(), d.contact_accessible.size(), M);
  const bool load_driven = d.attributes.parameters != Parameters::kDisplacement;
  const std::size_t Cf =
      load_driven ? 0 : coefficients("force_order", forceOrder(d.attributes), kMostForceOrder);
  expectSize(dataset::kContactForce.name(), d.contact_force.size(), M * Cf * 3);
  expectSize(dataset::kContactDisplacement.name(), d.contact_displacement.size(),
             load_driven ? M * C * 3 : 0);
  if (load_driven)
    expectSize(dataset::kContactStiffness.name(), d.contact_stiffness.size(), 0);
  else
    expectTuples(dataset::kContactStiffness.name(), d.contact_stiffness.size(), kStiffnessNumbers);
  expectSize(dataset::kContactDomainRadius.name(), d.contact_domain_radius.size(), M);
  expectSize(dataset::kContactSeriesRadius.name(), d.contact_series_radius.size(), load_driven ? 0 : M);
  expectTuples(dataset::kContactTriangles.name(), d.contact_triangles.size(), 3);
}

void checkLevels(const ModelData& d, std::size_t C) {
  if (d.attributes.parameters != Parameters::kLevel)
    return expectSize(dataset::kLevelsZ.name(), d.levels_Z.size(), 0);
  expectTuples(dataset::kLevelsZ.name(), d.levels_Z.size(), C);
  if (d.levels_Z.size() < 2 * C)
    throw ModelFileError(dataset::kLevelsZ.name() + " has " + std::to_string(d.levels_Z.size() / C) +
                         " levels, expected at least 2");
}

void checkFields(const ModelData& d, std::size_t Ns, std::size_t M, std::size_t C) {
  expectTuples(dataset::kModesX.name(), d.modes_X.size(), 3 * Ns);
  const std::size_t n = modeCount(d), Cm = modeCoefficients(d.attributes, C);
  expectSize(dataset::kModesY.name(), d.modes_Y.size(), M * Cm * positionModes(d));
  expectSize(dataset::kNearOffset.name(), d.near_offset.size(), M + 1);
  expectSize(dataset::kNearField.name(), d.near_field.size(), 3 * Cm * d.near_node.size());
  const bool displaced = d.attributes.parameters == Parameters::kDisplacement;
  const std::size_t G = displaced ? d.green_node.size() : 0;
  expectSize(dataset::kGreenNode.name(), d.green_node.size(), G);
  expectSize(dataset::kGreenY.name(), d.green_Y.size(), G * 3 * n);
  expectSize(dataset::kGreenOffset.name(), d.green_offset.size(), displaced ? G + 1 : 0);
  expectSize(dataset::kGreenNear.name(), d.green_near.size(), 9 * d.green_near_node.size());
  expectSize(dataset::kEdgeField.name(), d.edge_field.size(), 3 * edgeCoefficients(d) * d.edge_node.size());
}

void checkMesh(const ModelData& d) {
  expectSize(dataset::kMeshNodes.name(), d.mesh_nodes.size(), 3 * d.mesh_node_tag.size());
  expectSize(dataset::kMeshTetrahedra.name(), d.mesh_tetrahedra.size(), 4 * d.mesh_tetrahedron_tag.size());
  expectSize(dataset::kMeshMidsides.name(), d.mesh_midsides.size(),
             d.mesh_midsides.empty() ? 0 : 6 * d.mesh_tetrahedron_tag.size());
  const std::size_t R = d.region_name.size();
  expectSize(dataset::kElementRegion.name(), d.mesh_element_region.size(),
             R == 0 ? 0 : d.mesh_tetrahedron_tag.size());
  expectSize(dataset::kRegionE.name(), d.region_E.size(), R);
  expectSize(dataset::kRegionNu.name(), d.region_nu.size(), R);
  expectSize(dataset::kRegionLaw.name(), d.region_law.size(), R);
  expectSize(dataset::kSpringStiffness.name(), d.spring_stiffness.size(), d.spring_node.size());
}

}  // namespace

std::size_t fieldCoefficients(const ModelData& data) {
  if (data.attributes.parameters != Parameters::kLevel)
    return coefficients("order", data.attributes.order, kMostOrder);
  const std::size_t width = 3 * data.contact_node.size();
  if (width == 0)
    throw ModelFileError(dataset::kContactNode.name() + " is empty, expected contact positions");
  expectTuples(dataset::kContactDisplacement.name(), data.contact_displacement.size(), width);
  const std::size_t C = data.contact_displacement.size() / width;
  if (C == 0 || C > static_cast<std::size_t>(kMostLevelFunctions))
    throw ModelFileError(dataset::kContactDisplacement.name() + " has " + std::to_string(C) +
                         " level functions, expected 1 to " + std::to_string(kMostLevelFunctions));
  return C;
}

void checkSizes(const ModelData& data) {
  const std::size_t C = fieldCoefficients(data);
  const std::size_t Ns = data.surface_mesh_tag.size();
  const std::size_t M = data.contact_node.size();
  if (Ns == 0) throw ModelFileError(dataset::kSurfaceMeshTag.name() + " is empty, expected a surface");
  if (M == 0) throw ModelFileError(dataset::kContactNode.name() + " is empty, expected contact positions");
  checkSurface(data, Ns);
  checkContact(data, M, C);
  checkLevels(data, C);
  checkFields(data, Ns, M, C);
  checkMesh(data);
}

}  // namespace palpate::modelfile
