// SPDX-License-Identifier: Apache-2.0
#include "tools/mesh/midsides.h"

#include <algorithm>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

#include "tools/mesh/mesh_error.h"

namespace palpate::mesh {
namespace {

constexpr double kRounding = 1e-4;  // of the edge's length; files hold as few as six digits

struct EdgeNode {
  std::pair<std::int32_t, std::int32_t> edge;  // corners, ascending
  std::int32_t node;
  std::size_t tetrahedron;  // the first that has it

  auto key() const { return std::pair(edge, node); }
};

// Edges with their nodes, ascending; those that tetrahedra share once, unless their nodes differ.
std::vector<EdgeNode> edgesOf(const TetMesh& mesh) {
  std::vector<EdgeNode> edges;
  for (std::size_t t = 0; t < mesh.midsides.size(); ++t)
    for (std::size_t e = 0; e < kTetEdges.size(); ++e) {
      const auto corner = [&](std::size_t i) {
        return mesh.tetrahedra[t][static_cast<std::size_t>(kTetEdges[e][i])];
      };
      edges.push_back({std::minmax(corner(0), corner(1)), mesh.midsides[t][e], t});
    }
  std::stable_sort(edges.begin(), edges.end(),
                   [](const EdgeNode& a, const EdgeNode& b) { return a.key() < b.key(); });
  const auto end = std::unique(edges.begin(), edges.end(),
                               [](const EdgeNode& a, const EdgeNode& b) { return a.key() == b.key(); });
  edges.erase(end, edges.end());
  return edges;
}

const Eigen::Vector3d& at(const TetMesh& mesh, std::int32_t node) {
  return mesh.nodes[static_cast<std::size_t>(node)];
}

Eigen::Vector3d middleOf(const TetMesh& mesh, const EdgeNode& e) {
  return 0.5 * (at(mesh, e.edge.first) + at(mesh, e.edge.second));
}

double distanceFromMiddle(const TetMesh& mesh, const EdgeNode& e) {
  return (at(mesh, e.node) - middleOf(mesh, e)).norm();
}

// Negated, so that NaN is curved.
bool isCurved(const TetMesh& mesh, const EdgeNode& e) {
  return !(distanceFromMiddle(mesh, e) <=
           kRounding * (at(mesh, e.edge.first) - at(mesh, e.edge.second)).norm());
}

std::string inMillimetres(double length) {
  char text[40];
  std::snprintf(text, sizeof text, "%.3g mm", length * 1e3);
  return text;
}

[[noreturn]] void refuse(const TetMesh& mesh, const EdgeNode& e, const std::string& what) {
  throw MeshError("mid-side node " + std::to_string(mesh.node_tags[static_cast<std::size_t>(e.node)]) +
                  " of tetrahedron " + std::to_string(mesh.tetrahedron_tags[e.tetrahedron]) + ' ' + what);
}

}  // namespace

CurvedEdges straighten(TetMesh& mesh) {
  CurvedEdges curved;
  for (const EdgeNode& e : edgesOf(mesh)) {
    if (isCurved(mesh, e)) {
      ++curved.count;
      curved.farthest = std::max(curved.farthest, distanceFromMiddle(mesh, e));
    }
    mesh.nodes[static_cast<std::size_t>(e.node)] = middleOf(mesh, e);
  }
  return curved;
}

void checkMidsides(const TetMesh& mesh) {
  std::vector<bool> taken(mesh.nodes.size(), false);  // by a corner or an edge
  for (const auto& tetrahedron : mesh.tetrahedra)
    for (const auto corner : tetrahedron) taken[static_cast<std::size_t>(corner)] = true;
  const std::vector<EdgeNode> edges = edgesOf(mesh);
  for (std::size_t i = 0; i < edges.size(); ++i) {
    if (taken[static_cast<std::size_t>(edges[i].node)])
      refuse(mesh, edges[i], "is a corner or the middle of another edge too");
    taken[static_cast<std::size_t>(edges[i].node)] = true;
    if (i > 0 && edges[i].edge == edges[i - 1].edge) {
      refuse(mesh, edges[i],
             "is another than that of tetrahedron " +
                 std::to_string(mesh.tetrahedron_tags[edges[i - 1].tetrahedron]) + " on the same edge");
    }
  }
  for (const EdgeNode& e : edges) {
    if (!isCurved(mesh, e)) continue;
    refuse(mesh, e,
           "is " + inMillimetres(distanceFromMiddle(mesh, e)) +
               " off the middle of its edge (palpate-organ import moves it there)");
  }
}

}  // namespace palpate::mesh
