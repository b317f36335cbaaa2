// SPDX-License-Identifier: Apache-2.0
#include "check_sizes.h"

#include <cstddef>
#include <string>

#include "palpate/core/multi_index.h"
#include "palpate/modelfile/model_file.h"

namespace palpate::modelfile {

namespace {

void expectSize(const char* dataset, std::size_t found, std::size_t expected) {
  if (found != expected)
    throw ModelFileError(std::string("/") + dataset + " has " + std::to_string(found) +
                         " numbers, expected " + std::to_string(expected));
}

void expectTuples(const char* dataset, std::size_t found, std::size_t width) {
  if (found % width != 0)
    throw ModelFileError(std::string("/") + dataset + " has " + std::to_string(found) +
                         " numbers, expected a multiple of " + std::to_string(width));
}

std::size_t coefficients(int order) {
  if (order < 1 || order > MonomialBasis::kMaxOrder)
    throw ModelFileError("order is " + std::to_string(order) + ", expected 1 to " +
                         std::to_string(MonomialBasis::kMaxOrder));
  return static_cast<std::size_t>(MonomialBasis::size(order));
}

void checkSurface(const ModelData& d, std::size_t Ns) {
  expectSize("surface/positions", d.surface_positions.size(), 3 * Ns);
  expectTuples("surface/triangles", d.surface_triangles.size(), 3);
  expectSize("surface/position_of_node", d.position_of_node.size(), Ns);
  expectSize("mesh/surface_node", d.mesh_surface_node.size(), Ns);
}

void checkContact(const ModelData& d, std::size_t M, std::size_t C) {
  expectSize("contact/accessible", d.contact_accessible.size(), M);
  expectSize("contact/force", d.contact_force.size(), M * C * 3);
  expectSize("contact/domain_radius", d.contact_domain_radius.size(), M);
}

void checkFields(const ModelData& d, std::size_t Ns, std::size_t M, std::size_t C) {
  expectTuples("modes/X", d.modes_X.size(), 3 * Ns);
  expectSize("modes/Y", d.modes_Y.size(), M * C * (d.modes_X.size() / (3 * Ns)));
  expectSize("near/offset", d.near_offset.size(), M + 1);
  expectSize("near/field", d.near_field.size(), 3 * C * d.near_node.size());
}

void checkMesh(const ModelData& d) {
  expectSize("mesh/nodes", d.mesh_nodes.size(), 3 * d.mesh_node_tag.size());
  expectSize("mesh/tetrahedra", d.mesh_tetrahedra.size(), 4 * d.mesh_tetrahedron_tag.size());
}

}  // namespace

void checkSizes(const ModelData& data) {
  const std::size_t C = coefficients(data.attributes.order);
  const std::size_t Ns = data.surface_mesh_tag.size();
  const std::size_t M = data.contact_node.size();
  if (Ns == 0) throw ModelFileError("/surface/mesh_tag is empty, expected a surface");
  if (M == 0) throw ModelFileError("/contact/node is empty, expected contact positions");
  checkSurface(data, Ns);
  checkContact(data, M, coefficients(forceOrder(data.attributes)));
  checkFields(data, Ns, M, C);
  checkMesh(data);
}

}  // namespace palpate::modelfile
