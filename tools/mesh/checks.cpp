// SPDX-License-Identifier: Apache-2.0
#include "tools/mesh/checks.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>
#include <string>

#include "tools/mesh/manifold.h"
#include "tools/mesh/mesh_error.h"
#include "tools/mesh/midsides.h"
#include "tools/mesh/topology.h"

namespace palpate::mesh {
namespace {

constexpr double kFlat = 1e-9;       // volume over longest edge cubed; 0.118 for a regular tetrahedron
constexpr double kOnOneLine = 1e-6;  // distance from the line over the farthest node's distance

std::string tetName(const TetMesh& mesh, std::size_t t) {
  return "tetrahedron " + std::to_string(mesh.tetrahedron_tags[t]);
}

std::string nodeName(const TetMesh& mesh, std::size_t i) {
  return "node " + std::to_string(mesh.node_tags[i]);
}

// Volumes span many orders of magnitude: a fixed number of decimals would show a sliver as 0.
std::string inCubicMillimetres(double volume) {
  char text[40];
  std::snprintf(text, sizeof text, "(volume %.3g mm^3)", volume * 1e9);
  return text;
}

std::string faceName(const TetMesh& mesh, const TetFace& face) {
  std::string name = "face of nodes";
  for (const auto node : face.key) {
    name += ' ' + std::to_string(mesh.node_tags[static_cast<std::size_t>(node)]);
  }
  return name;
}

void checkSizes(const TetMesh& mesh) {
  if (mesh.tetrahedra.empty()) throw MeshError("the mesh holds no tetrahedra");
  if (mesh.node_tags.size() != mesh.nodes.size() || mesh.tetrahedron_tags.size() != mesh.tetrahedra.size()) {
    throw MeshError("the mesh has " + std::to_string(mesh.nodes.size()) + " nodes with " +
                    std::to_string(mesh.node_tags.size()) + " numbers and " +
                    std::to_string(mesh.tetrahedra.size()) + " tetrahedra with " +
                    std::to_string(mesh.tetrahedron_tags.size()) + " numbers");
  }
  if (mesh.isQuadratic() && mesh.midsides.size() != mesh.tetrahedra.size()) {
    throw MeshError("the mesh has " + std::to_string(mesh.tetrahedra.size()) + " tetrahedra, " +
                    std::to_string(mesh.midsides.size()) + " of them with mid-side nodes");
  }
}

void checkNodes(const TetMesh& mesh) {
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
    if (!mesh.nodes[i].allFinite())
      throw MeshError(nodeName(mesh, i) + " has a coordinate that is not finite");
  }
  std::vector<bool> used(mesh.nodes.size(), false);
  const auto use = [&](std::size_t t, std::int32_t node) {
    if (node < 0 || static_cast<std::size_t>(node) >= used.size()) {
      throw MeshError(tetName(mesh, t) + " refers to node index " + std::to_string(node) +
                      ", but there are " + std::to_string(used.size()) + " nodes");
    }
    used[static_cast<std::size_t>(node)] = true;
  };
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    for (const auto node : mesh.tetrahedra[t]) use(t, node);
    if (!mesh.isQuadratic()) continue;
    for (const auto node : mesh.midsides[t]) use(t, node);
  }
  const auto idle = std::find(used.begin(), used.end(), false);
  if (idle != used.end()) {
    throw MeshError(nodeName(mesh, static_cast<std::size_t>(idle - used.begin())) +
                    " belongs to no tetrahedron");
  }
}

double longestEdge(const TetMesh& mesh, std::size_t t) {
  double longest = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = i + 1; j < 4; ++j) {
      const auto a = static_cast<std::size_t>(mesh.tetrahedra[t][i]);
      const auto b = static_cast<std::size_t>(mesh.tetrahedra[t][j]);
      longest = std::max(longest, (mesh.nodes[a] - mesh.nodes[b]).norm());
    }
  }
  return longest;
}

void checkVolumes(const TetMesh& mesh) {
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    auto corners = mesh.tetrahedra[t];
    std::sort(corners.begin(), corners.end());
    const auto twin = std::adjacent_find(corners.begin(), corners.end());
    if (twin != corners.end()) {
      throw MeshError(tetName(mesh, t) + " has " + nodeName(mesh, static_cast<std::size_t>(*twin)) +
                      " twice");
    }
    const double volume = signedVolume(mesh, t);
    // Negated, so NaN from an overflow is refused as well.
    if (!(std::abs(volume) >= kFlat * std::pow(longestEdge(mesh, t), 3)) || volume == 0) {
      throw MeshError(tetName(mesh, t) + " is flat " + inCubicMillimetres(volume));
    }
    if (volume < 0) {
      throw MeshError(tetName(mesh, t) + " is inverted " + inCubicMillimetres(volume));
    }
  }
}

void checkDuplicates(const TetMesh& mesh) {
  std::vector<std::pair<std::array<std::int32_t, 4>, std::size_t>> sorted(mesh.tetrahedra.size());
  for (std::size_t t = 0; t < sorted.size(); ++t) {
    sorted[t] = {mesh.tetrahedra[t], t};
    std::sort(sorted[t].first.begin(), sorted[t].first.end());
  }
  std::sort(sorted.begin(), sorted.end());
  for (std::size_t t = 1; t < sorted.size(); ++t) {
    if (sorted[t].first == sorted[t - 1].first) {
      throw MeshError(tetName(mesh, sorted[t].second) + " has the same nodes as " +
                      tetName(mesh, sorted[t - 1].second));
    }
  }
}

// Whether the outward face is an even permutation of its corners in ascending order.
bool isEven(const TetMesh& mesh, const TetFace& face) {
  const auto& corners = kTetFaces[static_cast<std::size_t>(face.face)];
  const auto& t = mesh.tetrahedra[static_cast<std::size_t>(face.tetrahedron)];
  const auto a = t[static_cast<std::size_t>(corners[0])];
  const auto b = t[static_cast<std::size_t>(corners[1])];
  const auto c = t[static_cast<std::size_t>(corners[2])];
  return (a < b) == (b < c) ? a < b : a > c;
}

void checkFaces(const TetMesh& mesh, const std::vector<TetFace>& faces) {
  for (std::size_t i = 1; i < faces.size(); ++i) {
    if (faces[i].key != faces[i - 1].key) continue;
    if (i > 1 && faces[i - 2].key == faces[i].key) {
      throw MeshError(faceName(mesh, faces[i]) + " is shared by more than two tetrahedra, among them " +
                      tetName(mesh, static_cast<std::size_t>(faces[i].tetrahedron)));
    }
    if (isEven(mesh, faces[i]) == isEven(mesh, faces[i - 1])) {
      throw MeshError(tetName(mesh, static_cast<std::size_t>(faces[i].tetrahedron)) + " and " +
                      tetName(mesh, static_cast<std::size_t>(faces[i - 1].tetrahedron)) +
                      " overlap: they lie on the same side of their shared " + faceName(mesh, faces[i]));
    }
  }
}

void checkConnected(const TetMesh& mesh, const std::vector<TetFace>& faces) {
  std::vector<std::size_t> parent(mesh.tetrahedra.size());
  std::iota(parent.begin(), parent.end(), std::size_t{0});
  const auto root = [&](std::size_t t) {
    while (parent[t] != t) t = parent[t] = parent[parent[t]];
    return t;
  };
  for (std::size_t i = 1; i < faces.size(); ++i) {
    if (faces[i].key != faces[i - 1].key) continue;
    parent[root(static_cast<std::size_t>(faces[i].tetrahedron))] =
        root(static_cast<std::size_t>(faces[i - 1].tetrahedron));
  }
  std::vector<std::size_t> size(parent.size(), 0);
  for (std::size_t t = 0; t < parent.size(); ++t) ++size[root(t)];
  const auto biggest = static_cast<std::size_t>(std::max_element(size.begin(), size.end()) - size.begin());
  for (std::size_t t = 0; t < parent.size(); ++t) {
    if (root(t) == biggest) continue;
    throw MeshError("the mesh is disconnected: " + tetName(mesh, t) + " is in a part of " +
                    std::to_string(size[root(t)]) + " tetrahedra that shares no face with the other " +
                    std::to_string(size.size() - size[root(t)]));
  }
}

void checkBoundary(const TetMesh& mesh) {
  const BoundarySurface boundary = boundaryOf(mesh);
  const auto tag = [&](std::int32_t node) {
    return std::to_string(
        mesh.node_tags[static_cast<std::size_t>(boundary.nodes[static_cast<std::size_t>(node)])]);
  };
  const auto vertex_name = [&](std::int32_t node) { return "node " + tag(node); };
  const auto triangle_name = [&](std::int32_t t) {
    const auto& nodes = boundary.triangles[static_cast<std::size_t>(t)];
    return "boundary triangle of nodes " + tag(nodes[0]) + ' ' + tag(nodes[1]) + ' ' + tag(nodes[2]);
  };
  const auto defect = manifoldDefect(boundary.triangles, boundary.nodes.size(), vertex_name, triangle_name);
  if (defect) throw MeshError("the boundary is not a manifold: " + *defect);
}

}  // namespace

bool reorientIfAllNegative(TetMesh& mesh) {
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    if (!(signedVolume(mesh, t) < 0)) return false;
  }
  for (auto& t : mesh.tetrahedra) std::swap(t[2], t[3]);
  for (auto& m : mesh.midsides) {  // edges (1, 2) and (1, 3), (0, 2) and (0, 3) change places
    std::swap(m[1], m[4]);
    std::swap(m[2], m[3]);
  }
  return !mesh.tetrahedra.empty();
}

void checkMesh(const TetMesh& mesh) {
  checkSizes(mesh);
  checkNodes(mesh);
  checkVolumes(mesh);
  checkDuplicates(mesh);
  checkMidsides(mesh);
  const std::vector<TetFace> faces = sortedFaces(mesh);
  checkFaces(mesh, faces);
  checkConnected(mesh, faces);
  checkBoundary(mesh);
}

void checkHeld(const TetMesh& mesh, const std::string& group) {
  const std::string name = "group '" + group + "'";
  const auto found = mesh.groups.find(group);
  if (found == mesh.groups.end()) throw MeshError("there is no " + name + " to hold the organ");
  const auto& held = found->second;
  const std::string who = name + ": " + std::to_string(held.size()) + " nodes ";
  if (held.size() < 3) throw MeshError(who + "do not hold the organ; at least 3 are needed");
  const auto from_first = [&](std::int32_t node) -> Eigen::Vector3d {
    return mesh.nodes[static_cast<std::size_t>(node)] - mesh.nodes[static_cast<std::size_t>(held.front())];
  };
  Eigen::Vector3d along = Eigen::Vector3d::Zero();
  for (const auto node : held) {
    if (from_first(node).norm() > along.norm()) along = from_first(node);
  }
  const bool spread = std::any_of(held.begin(), held.end(), [&](std::int32_t node) {
    return from_first(node).cross(along).norm() > kOnOneLine * along.squaredNorm();
  });
  if (!spread) throw MeshError(who + "lie on one line and do not hold the organ");
}

}  // namespace palpate::mesh
