// SPDX-License-Identifier: Apache-2.0
#include "tools/make/organ/clamp.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace palpate::organ {

void setClamp(mesh::TetMesh& mesh, const mesh::BoundarySurface& boundary, std::vector<std::int32_t> fixed) {
  constexpr double kRimWidth = 0.015;  // m; a contact patch nearer to the clamp would lie half on it
  std::sort(fixed.begin(), fixed.end());
  const auto isClear = [&](std::int32_t node) {
    return std::none_of(fixed.begin(), fixed.end(), [&](std::int32_t held) {
      return (mesh.nodes[static_cast<std::size_t>(node)] - mesh.nodes[static_cast<std::size_t>(held)])
                 .norm() < kRimWidth;
    });
  };
  std::copy_if(boundary.nodes.begin(), boundary.nodes.end(), std::back_inserter(mesh.groups["accessible"]),
               isClear);
  mesh.groups["fixed"] = std::move(fixed);
}

}  // namespace palpate::organ
