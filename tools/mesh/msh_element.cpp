// SPDX-License-Identifier: Apache-2.0
#include "tools/mesh/msh_element.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <string>
#include <utility>

namespace palpate::mesh {

MshElementType mshElementType(const ByteReader& in, std::int64_t type, std::int64_t tag) {
  // Types 1 to 31 of the Gmsh format, in order: dimension and nodes.
  static constexpr std::array<MshElementType, 31> kTypes{
      {{1, 2},  {2, 3},  {2, 4},  {3, 4}, {3, 8}, {3, 6},  {3, 5},  {1, 3},  {2, 6}, {2, 9},  {3, 10},
       {3, 27}, {3, 18}, {3, 14}, {0, 1}, {2, 8}, {3, 20}, {3, 15}, {3, 13}, {2, 9}, {2, 10}, {2, 12},
       {2, 15}, {2, 15}, {2, 21}, {1, 4}, {1, 5}, {1, 6},  {3, 20}, {3, 35}, {3, 56}}};
  constexpr std::int64_t kTetrahedron = 4, kQuadratic = 11;
  const bool known = type >= 1 && type <= static_cast<std::int64_t>(kTypes.size());
  const MshElementType found = known ? kTypes[static_cast<std::size_t>(type - 1)] : MshElementType{3, 0};
  if (found.dimension == 3 && type != kTetrahedron && type != kQuadratic) {
    in.fail("element " + std::to_string(tag) + " is of Gmsh type " + std::to_string(type) +
            "; of volume elements only tetrahedra of 4 and 10 nodes (types 4 and 11) are taken");
  }
  return found;
}

void readMshElement(ByteReader& in, RawMesh& mesh, bool wide, std::int64_t tag, const MshElementType& type,
                    const std::vector<std::int64_t>& groups) {
  std::vector<std::int64_t> nodes(static_cast<std::size_t>(type.nodes));
  for (auto& node : nodes)
    node = wide ? in.integer64("an element's node") : in.integer32("an element's node");
  for (const auto group : groups) {
    if (group == 0) continue;
    auto& members = mesh.groups[{type.dimension, group}];
    members.insert(members.end(), nodes.begin(), nodes.end());
  }
  if (type.dimension != 3) return;
  if (nodes.size() == 10) std::swap(nodes[8], nodes[9]);  // Gmsh's last two edges are (2, 3) and (1, 3)
  RawMesh::Tetrahedron& added = mesh.tetrahedra.emplace_back(RawMesh::Tetrahedron{tag, std::move(nodes), {}});
  std::copy_if(groups.begin(), groups.end(), std::back_inserter(added.groups),
               [](std::int64_t group) { return group != 0; });
}

}  // namespace palpate::mesh
