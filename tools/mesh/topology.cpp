// SPDX-License-Identifier: Apache-2.0
#include "tools/mesh/topology.h"

#include <Eigen/Geometry>
#include <algorithm>

namespace palpate::mesh {

namespace {

struct FaceNodes {
  std::array<std::int32_t, 3> corners, middles;
};

/// Number of the edge between two corners in kTetEdges.
std::size_t edgeOf(int a, int b) {
  std::size_t e = 0;
  while (std::minmax(a, b) != std::minmax(kTetEdges[e][0], kTetEdges[e][1])) ++e;
  return e;
}

/// Counter-clockwise from outside. The middles of linear elements are no nodes.
FaceNodes nodesOf(const TetMesh& mesh, const TetFace& face) {
  const auto t = static_cast<std::size_t>(face.tetrahedron);
  const std::array<int, 3>& corner = kTetFaces[static_cast<std::size_t>(face.face)];
  FaceNodes nodes{};
  for (std::size_t k = 0; k < 3; ++k) {
    nodes.corners[k] = mesh.tetrahedra[t][static_cast<std::size_t>(corner[k])];
    if (mesh.isQuadratic()) nodes.middles[k] = mesh.midsides[t][edgeOf(corner[k], corner[(k + 1) % 3])];
  }
  return nodes;
}

/// Makes numbers of volume nodes numbers of boundary nodes.
void numberFromZero(std::size_t nodes, BoundarySurface& boundary) {
  std::vector<std::int32_t> local(nodes, -1);
  for (const auto& triangle : boundary.triangles)
    for (const std::int32_t node : triangle) local[static_cast<std::size_t>(node)] = 0;
  for (std::size_t i = 0; i < local.size(); ++i) {
    if (local[i] < 0) continue;
    local[i] = static_cast<std::int32_t>(boundary.nodes.size());
    boundary.nodes.push_back(static_cast<std::int32_t>(i));
  }
  for (auto* list : {&boundary.triangles, &boundary.faces})
    for (auto& triangle : *list)
      for (std::int32_t& node : triangle) node = local[static_cast<std::size_t>(node)];
}

}  // namespace

std::vector<TetFace> sortedFaces(const TetMesh& mesh) {
  std::vector<TetFace> faces;
  faces.reserve(4 * mesh.tetrahedra.size());
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    for (std::size_t f = 0; f < 4; ++f) {
      TetFace face{{}, static_cast<std::int32_t>(t), static_cast<std::int32_t>(f)};
      for (std::size_t i = 0; i < 3; ++i) {
        face.key[i] = mesh.tetrahedra[t][static_cast<std::size_t>(kTetFaces[f][i])];
      }
      std::sort(face.key.begin(), face.key.end());
      faces.push_back(face);
    }
  }
  std::sort(faces.begin(), faces.end(), [](const TetFace& a, const TetFace& b) {
    return a.key != b.key ? a.key < b.key : a.tetrahedron < b.tetrahedron;
  });
  return faces;
}

BoundarySurface boundaryOf(const TetMesh& mesh) {
  const std::vector<TetFace> faces = sortedFaces(mesh);
  BoundarySurface boundary;
  for (std::size_t i = 0; i < faces.size(); ++i) {
    const bool as_before = i > 0 && faces[i].key == faces[i - 1].key;
    const bool as_after = i + 1 < faces.size() && faces[i].key == faces[i + 1].key;
    if (as_before || as_after) continue;
    const FaceNodes face = nodesOf(mesh, faces[i]);
    boundary.faces.push_back(face.corners);
    if (!mesh.isQuadratic()) continue;
    for (const auto& triangle : splitFace(face.corners, face.middles)) boundary.triangles.push_back(triangle);
  }
  if (!mesh.isQuadratic()) boundary.triangles = boundary.faces;
  numberFromZero(mesh.nodes.size(), boundary);
  return boundary;
}

double signedVolume(const TetMesh& mesh, std::size_t tetrahedron) {
  const auto& t = mesh.tetrahedra[tetrahedron];
  const auto at = [&](std::size_t i) -> const Eigen::Vector3d& {
    return mesh.nodes[static_cast<std::size_t>(t[i])];
  };
  return (at(1) - at(0)).dot((at(2) - at(0)).cross(at(3) - at(0))) / 6;
}

}  // namespace palpate::mesh
