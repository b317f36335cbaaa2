// SPDX-License-Identifier: Apache-2.0
#include "tools/examine/certify/report/surface_maps.h"

#include <algorithm>

#include "core/response/patch_response.h"

namespace palpate::certify {

std::optional<std::size_t> SurfaceMaps::typicalNode(const MetaModel& model) const {
  std::vector<std::size_t> nodes;
  for (std::size_t i = 0; i < normal_stiffness.size(); ++i)
    if (normal_stiffness[i] && model.view().position_of_node[i] >= 0) nodes.push_back(i);
  if (nodes.empty()) return {};
  const auto median = nodes.begin() + static_cast<std::ptrdiff_t>(nodes.size() / 2);
  std::nth_element(nodes.begin(), median, nodes.end(), [this](std::size_t a, std::size_t b) {
    return normal_stiffness[a] != normal_stiffness[b] ? normal_stiffness[a] < normal_stiffness[b] : a < b;
  });
  return *median;
}

SurfaceMaps surfaceMapsOf(const MetaModel& model) {
  const std::vector<std::uint8_t> accessible = model.accessibleNodes();
  SurfaceMaps maps;
  for (std::size_t i = 0; i < accessible.size(); ++i) {
    std::optional<double> radius, stiffness;
    const auto node = static_cast<int>(i);
    Response at_rest;
    if (accessible[i] != 0 &&
        respond(model, model.surface().atNode(node), Vec3::Zero(), at_rest) != ResponseStatus::kNoAnswer) {
      const Vec3& n = model.surface().nodeNormal(node);
      radius = at_rest.domain_radius;
      stiffness = n.dot(at_rest.stiffness * n);
    }
    maps.domain_radius.push_back(radius);
    maps.normal_stiffness.push_back(stiffness);
  }
  return maps;
}

}  // namespace palpate::certify
