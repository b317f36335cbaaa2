// SPDX-License-Identifier: Apache-2.0
#include "tools/make/organ/painted_groups.h"

#include <algorithm>
#include <array>
#include <vector>

#include "tools/make/organ/repair/nearest_triangle.h"

namespace palpate::organ {

void addPaintedGroups(const mesh::TriangleSurface& painted, const mesh::BoundarySurface& boundary,
                      mesh::TetMesh& mesh) {
  if (painted.groups.empty()) return;
  std::vector<std::vector<std::vector<std::int32_t>*>> groups_of(painted.triangles.size());
  for (const auto& [name, triangles] : painted.groups)
    for (auto* nodes = &mesh.groups[name]; const auto t : triangles)
      groups_of[static_cast<std::size_t>(t)].push_back(nodes);
  const NearestTriangle nearest(painted);
  for (const auto& t : boundary.triangles) {
    std::array<std::int32_t, 3> corners{};
    Eigen::Vector3d middle = Eigen::Vector3d::Zero();
    for (std::size_t k = 0; k < 3; ++k) {
      corners[k] = boundary.nodes[static_cast<std::size_t>(t[k])];
      middle += mesh.nodes[static_cast<std::size_t>(corners[k])] / 3;
    }
    for (auto* nodes : groups_of[nearest.to(middle)])
      nodes->insert(nodes->end(), corners.begin(), corners.end());
  }
  for (const auto& [name, triangles] : painted.groups) {
    std::vector<std::int32_t>& nodes = mesh.groups[name];
    std::sort(nodes.begin(), nodes.end());
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  }
}

}  // namespace palpate::organ
