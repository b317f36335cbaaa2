// SPDX-License-Identifier: Apache-2.0
#include "tools/mesh/msh_element.h"

#include <array>
#include <string>

namespace palpate::mesh {

MshElementType mshElementType(const ByteReader& in, std::int64_t type, std::int64_t tag) {
  // Types 1 to 31 of the Gmsh format, in order: dimension and nodes.
  static constexpr std::array<MshElementType, 31> kTypes{
      {{1, 2},  {2, 3},  {2, 4},  {3, 4}, {3, 8}, {3, 6},  {3, 5},  {1, 3},  {2, 6}, {2, 9},  {3, 10},
       {3, 27}, {3, 18}, {3, 14}, {0, 1}, {2, 8}, {3, 20}, {3, 15}, {3, 13}, {2, 9}, {2, 10}, {2, 12},
       {2, 15}, {2, 15}, {2, 21}, {1, 4}, {1, 5}, {1, 6},  {3, 20}, {3, 35}, {3, 56}}};
  constexpr std::int64_t kTetrahedron = 4;
  const bool known = type >= 1 && type <= static_cast<std::int64_t>(kTypes.size());
  const MshElementType found = known ? kTypes[static_cast<std::size_t>(type - 1)] : MshElementType{3, 0};
  if (found.dimension == 3 && type != kTetrahedron) {
    in.fail("element " + std::to_string(tag) + " is of Gmsh type " + std::to_string(type) +
            "; of volume elements only linear tetrahedra (type 4) are taken");
  }
  return found;
}

void readMshElement(ByteReader& in, RawMesh& mesh, bool wide, std::int64_t tag, const MshElementType& type,
                    const std::vector<std::int64_t>& groups) {
  std::vector<std::int64_t> nodes(static_cast<std::size_t>(type.nodes));
  for (auto& node : nodes)
    node = wide ? in.integer64("an element's node") : in.integer32("an element's node");
  if (type.dimension == 3) {
    mesh.tetrahedra.push_back({nodes[0], nodes[1], nodes[2], nodes[3]});
    mesh.tetrahedron_tags.push_back(tag);
  }
  for (const auto group : groups) {
    if (group == 0) continue;
    auto& members = mesh.groups[{type.dimension, group}];
    members.insert(members.end(), nodes.begin(), nodes.end());
  }
}

}  // namespace palpate::mesh
