// SPDX-License-Identifier: Apache-2.0
#include "tools/mesh/raw_mesh.h"

#include <algorithm>
#include <limits>
#include <unordered_map>

#include "tools/mesh/mesh_error.h"

namespace palpate::mesh {
namespace {

using TagIndex = std::unordered_map<std::int64_t, std::size_t>;

TagIndex indexOf(const std::string& file, const RawMesh& raw) {
  TagIndex index;
  index.reserve(raw.point_tags.size());
  for (std::size_t i = 0; i < raw.point_tags.size(); ++i) {
    if (!index.emplace(raw.point_tags[i], i).second) {
      throw MeshError(file + ": node " + std::to_string(raw.point_tags[i]) + " is there twice");
    }
  }
  return index;
}

std::size_t find(const std::string& file, const TagIndex& index, std::int64_t tag, const std::string& who) {
  const auto found = index.find(tag);
  if (found == index.end()) {
    throw MeshError(file + ": " + who + " refers to node " + std::to_string(tag) +
                    ", which is not in the file");
  }
  return found->second;
}

// The name of a group that the file does not name: its number, with the dimension where the number is
// ambiguous.
std::string nameOf(const RawMesh& raw, const RawMesh::GroupId& id) {
  static constexpr std::array<const char*, 4> kDimensions{"point:", "curve:", "surface:", "volume:"};
  const auto named = raw.group_names.find(id);
  if (named != raw.group_names.end() && !named->second.empty()) return named->second;
  const std::string number = std::to_string(id.second);
  for (int dimension = 0; dimension < 4; ++dimension) {
    if (dimension == id.first || !raw.groups.contains({dimension, id.second})) continue;
    return kDimensions[static_cast<std::size_t>(id.first)] + number;
  }
  return number;
}

void addGroups(const std::string& file, const RawMesh& raw, const TagIndex& index,
               const std::vector<std::int32_t>& kept, TetMesh& mesh) {
  for (const auto& [id, tags] : raw.groups) {
    const std::string name = nameOf(raw, id);
    auto& nodes = mesh.groups[name];
    for (const auto tag : tags) {
      const auto node = kept[find(file, index, tag, "group '" + name + "'")];
      if (node >= 0) nodes.push_back(node);
    }
    std::sort(nodes.begin(), nodes.end());
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  }
  std::erase_if(mesh.groups, [](const auto& group) { return group.second.empty(); });
}

void addRegions(const RawMesh& raw, TetMesh& mesh) {
  for (std::size_t t = 0; t < raw.tetrahedra.size(); ++t)
    for (const auto group : raw.tetrahedra[t].groups) {
      auto& region = mesh.regions[nameOf(raw, {3, group})];
      const auto index = static_cast<std::int32_t>(t);
      if (region.empty() || region.back() != index) region.push_back(index);  // two groups of one name
    }
}

// Points of each tetrahedron, by their place in the file.
void addTetrahedra(const std::string& file, const RawMesh& raw, const TagIndex& index, TetMesh& mesh) {
  const std::size_t nodes = raw.tetrahedra.front().nodes.size();
  for (const auto& tetrahedron : raw.tetrahedra) {
    const std::string who = "tetrahedron " + std::to_string(tetrahedron.tag);
    if (tetrahedron.nodes.size() != nodes) {
      throw MeshError(file + ": " + who + " has " + std::to_string(tetrahedron.nodes.size()) +
                      " nodes, tetrahedron " + std::to_string(raw.tetrahedra.front().tag) + " has " +
                      std::to_string(nodes) + "; all must have 4 or all 10");
    }
    const auto point = [&](std::size_t i) {
      return static_cast<std::int32_t>(find(file, index, tetrahedron.nodes[i], who));
    };
    mesh.tetrahedron_tags.push_back(tetrahedron.tag);
    mesh.tetrahedra.push_back({point(0), point(1), point(2), point(3)});
    if (nodes == 10) mesh.midsides.push_back({point(4), point(5), point(6), point(7), point(8), point(9)});
  }
}

// Keeps the points that tetrahedra use. @return the node of each point, or -1
std::vector<std::int32_t> keepUsed(const RawMesh& raw, TetMesh& mesh) {
  std::vector<std::int32_t> kept(raw.points.size(), -1);
  const auto forAllNodes = [&](const auto& work) {
    for (auto& corners : mesh.tetrahedra) std::for_each(corners.begin(), corners.end(), work);
    for (auto& middles : mesh.midsides) std::for_each(middles.begin(), middles.end(), work);
  };
  forAllNodes([&](std::int32_t point) { kept[static_cast<std::size_t>(point)] = 0; });
  for (std::size_t i = 0; i < kept.size(); ++i) {
    if (kept[i] < 0) continue;
    kept[i] = static_cast<std::int32_t>(mesh.nodes.size());
    mesh.nodes.push_back(raw.points[i]);
    mesh.node_tags.push_back(raw.point_tags[i]);
  }
  forAllNodes([&](std::int32_t& point) { point = kept[static_cast<std::size_t>(point)]; });
  return kept;
}

}  // namespace

TetMesh assemble(const std::filesystem::path& path, const RawMesh& raw) {
  const std::string file = path.string();
  if (raw.tetrahedra.empty()) throw MeshError(file + ": the file holds no tetrahedra");
  if (raw.points.size() > static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max())) {
    throw MeshError(file + ": " + std::to_string(raw.points.size()) + " nodes are too many");
  }
  const TagIndex index = indexOf(file, raw);
  TetMesh mesh;
  addTetrahedra(file, raw, index, mesh);
  addGroups(file, raw, index, keepUsed(raw, mesh), mesh);
  addRegions(raw, mesh);
  return mesh;
}

}  // namespace palpate::mesh
