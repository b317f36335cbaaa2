// SPDX-License-Identifier: Apache-2.0
#include "tools/mesh/quadratic.h"

#include <algorithm>
#include <iterator>
#include <limits>
#include <map>
#include <string>
#include <utility>

#include "tools/mesh/mesh_error.h"
#include "tools/mesh/topology.h"

namespace palpate::mesh {

namespace {

using Edge = std::pair<std::int32_t, std::int32_t>;  // its ends, ascending
using Middles = std::map<Edge, std::int32_t>;

/// A group's corners, and the middles of edges with both ends among them.
std::vector<std::int32_t> withMiddles(const std::vector<std::int32_t>& corners, const Middles& middles) {
  const auto has = [&](std::int32_t node) {
    return std::binary_search(corners.begin(), corners.end(), node);
  };
  std::vector<std::int32_t> all = corners;
  for (const auto& [edge, middle] : middles)
    if (has(edge.first) && has(edge.second)) all.push_back(middle);
  std::sort(all.begin(), all.end());
  return all;
}

std::vector<std::int32_t> common(const std::vector<std::int32_t>& a, const std::vector<std::int32_t>& b) {
  std::vector<std::int32_t> both;
  std::set_intersection(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(both));
  return both;
}

}  // namespace

TetMesh quadraticOf(const TetMesh& linear) {
  TetMesh mesh = linear;
  std::int64_t tag = *std::max_element(mesh.node_tags.begin(), mesh.node_tags.end());
  const auto most = static_cast<std::int64_t>(kTetEdges.size() * linear.tetrahedra.size());
  if (tag > std::numeric_limits<std::int64_t>::max() - most)
    throw MeshError("node " + std::to_string(tag) + ": no numbers are left for nodes in the middle of edges");
  Middles middles;
  for (const auto& t : linear.tetrahedra) {
    std::array<std::int32_t, 6>& added = mesh.midsides.emplace_back();
    for (std::size_t e = 0; e < added.size(); ++e) {
      const auto end = [&](std::size_t i) { return t[static_cast<std::size_t>(kTetEdges[e][i])]; };
      const auto at = [&](std::size_t i) { return linear.nodes[static_cast<std::size_t>(end(i))]; };
      const auto [found, is_new] =
          middles.try_emplace(std::minmax(end(0), end(1)), static_cast<std::int32_t>(mesh.nodes.size()));
      added[e] = found->second;
      if (!is_new) continue;
      mesh.nodes.push_back(0.5 * (at(0) + at(1)));
      mesh.node_tags.push_back(++tag);
    }
  }
  const std::vector<std::int32_t> surface = boundaryOf(mesh).nodes;
  for (auto& [name, nodes] : mesh.groups) {
    const bool of_surface = !linear.regions.contains(name) && nodes.size() < linear.nodes.size() &&
                            std::includes(surface.begin(), surface.end(), nodes.begin(), nodes.end());
    nodes = withMiddles(nodes, middles);
    if (of_surface) nodes = common(nodes, surface);
  }
  return mesh;
}

}  // namespace palpate::mesh
