// SPDX-License-Identifier: Apache-2.0
#include "mesh_taken.h"

#include <algorithm>
#include <utility>

#include "tools/mesh/mesh_error.h"

namespace palpate::fuzz {

namespace {

mesh::ByteReader readerOf(Bytes input) {
  return {"mesh", std::string(input.begin(), input.end())};
}

template <class List>
void requireBelow(const List& indices, std::size_t count) {
  for (const auto index : indices)
    require(index >= 0 && static_cast<std::size_t>(index) < count, "an index is out of its range");
}

void look(const mesh::TetMesh& mesh) {
  require(mesh.node_tags.size() == mesh.nodes.size(), "each node has a number");
  require(!mesh.tetrahedra.empty() && mesh.tetrahedron_tags.size() == mesh.tetrahedra.size(),
          "each tetrahedron has a number");
  require(mesh.midsides.empty() || mesh.midsides.size() == mesh.tetrahedra.size(),
          "all have midsides or none");
  for (const auto& corners : mesh.tetrahedra) requireBelow(corners, mesh.nodes.size());
  for (const auto& middles : mesh.midsides) requireBelow(middles, mesh.nodes.size());
  for (const auto& [name, nodes] : mesh.groups) requireBelow(nodes, mesh.nodes.size());
  for (const auto& [name, tetrahedra] : mesh.regions) requireBelow(tetrahedra, mesh.tetrahedra.size());
}

void look(const mesh::TriangleSurface& surface) {
  require(surface.vertex_tags.size() == surface.vertices.size(), "each vertex has a number");
  require(surface.triangle_tags.size() == surface.triangles.size(), "each triangle has a number");
  for (const auto& corners : surface.triangles) requireBelow(corners, surface.vertices.size());
  for (const auto& [name, triangles] : surface.groups) {
    requireBelow(triangles, surface.triangles.size());
    require(std::is_sorted(triangles.begin(), triangles.end()), "triangles of a group ascend");
  }
}

}  // namespace

// Importers go on to checkMesh() and to surfaces: these are not fuzzed, only that a mesh comes to them with indices in range.
bool taken(Bytes input, mesh::RawMesh (*read)(mesh::ByteReader)) {
  try {
    look(mesh::assemble("mesh", read(readerOf(input))));
  } catch (const mesh::MeshError&) {
    return false;
  }
  return true;
}

bool taken(Bytes input, mesh::TriangleSurface (*read)(mesh::ByteReader)) {
  try {
    look(read(readerOf(input)));
  } catch (const mesh::MeshError&) {
    return false;
  }
  return true;
}

}  // namespace palpate::fuzz
