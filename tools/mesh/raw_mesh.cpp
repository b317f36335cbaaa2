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

}  // namespace

TetMesh assemble(const std::filesystem::path& path, const RawMesh& raw) {
  const std::string file = path.string();
  if (raw.tetrahedra.empty()) throw MeshError(file + ": the file holds no tetrahedra");
  if (raw.points.size() > static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max())) {
    throw MeshError(file + ": " + std::to_string(raw.points.size()) + " nodes are too many");
  }
  const TagIndex index = indexOf(file, raw);
  TetMesh mesh;
  mesh.tetrahedron_tags = raw.tetrahedron_tags;
  std::vector<std::int32_t> kept(raw.points.size(), -1);
  for (std::size_t t = 0; t < raw.tetrahedra.size(); ++t) {
    std::array<std::int32_t, 4> corners{};
    const std::string who = "tetrahedron " + std::to_string(raw.tetrahedron_tags[t]);
    for (std::size_t i = 0; i < 4; ++i) {
      const std::size_t point = find(file, index, raw.tetrahedra[t][i], who);
      kept[point] = 0;
      corners[i] = static_cast<std::int32_t>(point);
    }
    mesh.tetrahedra.push_back(corners);
  }
  for (std::size_t i = 0; i < kept.size(); ++i) {
    if (kept[i] < 0) continue;
    kept[i] = static_cast<std::int32_t>(mesh.nodes.size());
    mesh.nodes.push_back(raw.points[i]);
    mesh.node_tags.push_back(raw.point_tags[i]);
  }
  for (auto& corners : mesh.tetrahedra) {
    for (auto& corner : corners) corner = kept[static_cast<std::size_t>(corner)];
  }
  addGroups(file, raw, index, kept, mesh);
  return mesh;
}

}  // namespace palpate::mesh
