// SPDX-License-Identifier: Apache-2.0
#include "tools/solver/build/case_material.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cstddef>
#include <map>
#include <string>
#include <variant>

#include "core/base/index.h"
#include "tools/mesh/topology.h"

namespace palpate::solver {

namespace {

/// @param place  file, line and key that name the group  @param kind  of group, for the message
const std::vector<std::int32_t>& membersOf(const std::map<std::string, std::vector<std::int32_t>>& groups,
                                           const std::string& group, const std::string& place,
                                           const std::string& kind) {
  if (const auto found = groups.find(group); found != groups.end() && !found->second.empty())
    return found->second;
  std::string list;
  for (const auto& [name, members] : groups) list += (list.empty() ? "" : ", ") + name;
  throw CaseError(place + " = \"" + group + "\" is no group of " + kind +
                  " of the mesh (there are: " + (list.empty() ? "none" : list) + ")");
}

Region regionOf(const RegionCase& r, const Case& c) {
  if (r.group.size() > RegionName{}.size())
    throw CaseError(r.place + " = \"" + r.group + "\" is longer than " + std::to_string(RegionName{}.size()) +
                    " bytes");
  return {r.group, {r.E, r.nu.value_or(c.nu)}, lawOf(r.law.value_or(c.law))};
}

/// Integrals of the shape functions over the faces that lie in a group whole, by node: a third of the area at the corners
/// of linear faces, at the mid-sides of quadratic ones.
std::map<std::int32_t, double> areasOf(const mesh::TetMesh& mesh, const mesh::BoundarySurface& boundary,
                                       const std::vector<std::int32_t>& group) {
  const std::size_t flat = mesh.isQuadratic() ? 4 : 1;  // triangles of a face; the last has the mid-sides
  std::map<std::int32_t, double> areas;
  for (std::size_t begin = 0; begin < boundary.triangles.size(); begin += flat) {
    const auto node = [&](std::size_t t, std::size_t k) {
      return boundary.nodes[index(boundary.triangles[begin + t][k])];
    };
    bool inside = true;
    for (std::size_t t = 0; t < flat; ++t)
      for (std::size_t k = 0; k < 3; ++k)
        inside = inside && std::binary_search(group.begin(), group.end(), node(t, k));
    if (!inside) continue;
    const auto X = [&](std::size_t k) { return mesh.nodes[index(node(flat - 1, k))]; };
    const double area = static_cast<double>(flat) * 0.5 * (X(1) - X(0)).cross(X(2) - X(0)).norm();
    for (std::size_t k = 0; k < 3; ++k) areas[node(flat - 1, k)] += area / 3.0;
  }
  return areas;
}

}  // namespace

Material materialOf(const Case& c, const mesh::TetMesh& mesh) {
  Material material{{c.E, c.nu}, lawOf(c.law)};
  if (c.regions.empty()) return material;
  material.regions.push_back({"elsewhere", material.elasticity, material.law});
  material.region_of_element.assign(mesh.tetrahedra.size(), 0);
  for (const RegionCase& r : c.regions) {
    const auto number = static_cast<std::int32_t>(material.regions.size());
    for (const std::int32_t e : membersOf(mesh.regions, r.group, r.place, "tetrahedra")) {
      std::int32_t& region = material.region_of_element[index(e)];
      if (region != 0)
        throw CaseError(r.place + " = \"" + r.group + "\" overlaps region \"" +
                        material.regions[index(region)].name + "\" in tetrahedron " +
                        std::to_string(mesh.tetrahedron_tags[index(e)]));
      region = number;
    }
    material.regions.push_back(regionOf(r, c));
  }
  return material;
}

std::vector<Spring> springsOf(const Case& c, const mesh::TetMesh& mesh) {
  std::vector<Spring> springs;
  if (c.springs.empty()) return springs;
  const mesh::BoundarySurface boundary = mesh::boundaryOf(mesh);
  const auto fixed = mesh.groups.find(c.fixed);
  std::map<std::int32_t, double> stiffness;
  for (const SpringCase& s : c.springs) {
    const auto areas = areasOf(mesh, boundary, membersOf(mesh.groups, s.group, s.place, "nodes"));
    if (areas.empty())
      throw CaseError(s.place + " = \"" + s.group + "\" holds no face of the boundary: springs need an area");
    for (const auto& [node, area] : areas) stiffness[node] += s.stiffness * area;
  }
  for (const auto& [node, k] : stiffness)
    if (fixed == mesh.groups.end() || !std::binary_search(fixed->second.begin(), fixed->second.end(), node))
      springs.push_back({node, k});
  return springs;
}

void storeMaterial(const FeModel& model, modelfile::ModelData& data) {
  const Material& material = model.material();
  data.mesh_element_region = material.region_of_element;
  for (const Region& region : material.regions) {
    data.region_name.push_back(regionName(region.name));
    data.region_E.push_back(region.elasticity.E);
    data.region_nu.push_back(region.elasticity.nu);
    data.region_law.push_back(
        regionName(std::visit([](auto law) { return std::string_view(law.kName); }, region.law)));
  }
  for (const auto& [node, stiffness] : model.springs()) {
    data.spring_node.push_back(node);
    data.spring_stiffness.push_back(stiffness);
  }
}

}  // namespace palpate::solver
