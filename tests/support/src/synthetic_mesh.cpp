// SPDX-License-Identifier: Apache-2.0
#include "synthetic_mesh.h"

#include <algorithm>

namespace palpate::testing {

void fillSyntheticMesh(const SyntheticOptions& o, const Icosphere& sphere, modelfile::ModelData& data) {
  const auto centre = static_cast<std::int32_t>(sphere.nodes.size());
  data.mesh_nodes = data.surface_positions;
  data.mesh_nodes.resize(data.mesh_nodes.size() + 3, 0.0);
  data.mesh_node_tag = data.surface_mesh_tag;
  data.mesh_node_tag.push_back(centre + 1);
  std::vector<std::int32_t> region_of;
  for (const auto& [a, b, c] : sphere.triangles) {
    data.mesh_tetrahedra.insert(data.mesh_tetrahedra.end(), {centre, a, b, c});
    data.mesh_tetrahedron_tag.push_back(static_cast<std::int64_t>(data.mesh_tetrahedron_tag.size()) + 1);
    const auto z = [&](std::int32_t node) { return sphere.nodes[static_cast<std::size_t>(node)].z(); };
    region_of.push_back(z(a) + z(b) + z(c) > 3.0 * o.nodule_above ? 1 : 0);
  }
  if (std::find(region_of.begin(), region_of.end(), 1) == region_of.end()) return;
  data.mesh_element_region = region_of;
  data.region_name = {regionName("elsewhere"), regionName("nodule")};
  data.region_E = {data.attributes.E, 10.0 * data.attributes.E};
  data.region_nu.assign(2, data.attributes.nu);
  data.region_law.assign(2, regionName(data.attributes.law));
}

}  // namespace palpate::testing
