// SPDX-License-Identifier: Apache-2.0
#include "tools/mesh/box_mesh.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <string>

#include "tools/mesh/mesh_error.h"
#include "tools/mesh/topology.h"

namespace palpate::mesh {
namespace {

void checkArguments(const Eigen::Vector3d& size, const std::array<int, 3>& nodes) {
  double total = 1;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (!(size[static_cast<Eigen::Index>(axis)] > 0)) throw MeshError("a box needs positive edge lengths");
    if (nodes[axis] < 2)
      throw MeshError("a box needs at least 2 nodes along each axis, not " + std::to_string(nodes[axis]));
    total *= nodes[axis];
  }
  if (total > std::numeric_limits<std::int32_t>::max())
    throw MeshError("a box of this many nodes is too large");
}

// The six paths along cell edges from the smallest to the largest corner, each a tetrahedron.
void addCell(TetMesh& mesh, std::int32_t corner, const std::array<std::int32_t, 3>& stride) {
  std::array<std::size_t, 3> axes{0, 1, 2};
  do {
    std::array<std::int32_t, 4> t{};
    t[0] = corner;
    for (std::size_t i = 0; i < 3; ++i) t[i + 1] = t[i] + stride[axes[i]];
    const bool even = (axes[0] + 1) % 3 == axes[1];
    if (!even) std::swap(t[1], t[2]);
    mesh.tetrahedra.push_back(t);
  } while (std::next_permutation(axes.begin(), axes.end()));
}

}  // namespace

TetMesh makeBox(const Eigen::Vector3d& size, const std::array<int, 3>& nodes) {
  checkArguments(size, nodes);
  TetMesh mesh;
  const std::array<std::int32_t, 3> stride{1, nodes[0], nodes[0] * nodes[1]};
  for (int k = 0; k < nodes[2]; ++k) {
    for (int j = 0; j < nodes[1]; ++j) {
      for (int i = 0; i < nodes[0]; ++i) {
        // Multiply first: the far face then lies at exactly `size`.
        mesh.nodes.emplace_back(size.x() * i / (nodes[0] - 1), size.y() * j / (nodes[1] - 1),
                                size.z() * k / (nodes[2] - 1));
        if (i + 1 < nodes[0] && j + 1 < nodes[1] && k + 1 < nodes[2]) {
          addCell(mesh, i * stride[0] + j * stride[1] + k * stride[2], stride);
        }
      }
    }
  }
  mesh.node_tags.resize(mesh.nodes.size());
  mesh.tetrahedron_tags.resize(mesh.tetrahedra.size());
  std::iota(mesh.node_tags.begin(), mesh.node_tags.end(), 1);
  std::iota(mesh.tetrahedron_tags.begin(), mesh.tetrahedron_tags.end(), 1);
  return mesh;
}

TetMesh makeBeam() {
  TetMesh mesh = makeBox({0.4, 0.04, 0.04}, {21, 9, 9});
  for (const auto node : boundaryOf(mesh).nodes) {
    const bool clamped = mesh.nodes[static_cast<std::size_t>(node)].x() == 0;
    mesh.groups[clamped ? "fixed" : "accessible"].push_back(node);
  }
  return mesh;
}

}  // namespace palpate::mesh
