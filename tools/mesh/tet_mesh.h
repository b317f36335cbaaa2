// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace palpate::mesh {

/// A volume mesh of linear tetrahedra for the solver: every node belongs to a tetrahedron, every tetrahedron
/// has positive volume (nodes 1, 2, 3 counter-clockwise seen from outside node 0's opposite).
struct TetMesh {
  std::vector<Eigen::Vector3d> nodes;   ///< N rest positions X, m
  std::vector<std::int64_t> node_tags;  ///< N numbers of the nodes in the mesh file, 1-based there
  std::vector<std::array<std::int32_t, 4>> tetrahedra;  ///< T x 4, 0-based into nodes
  std::vector<std::int64_t> tetrahedron_tags;           ///< T numbers in the mesh file
  std::map<std::string, std::vector<std::int32_t>>
      groups;  ///< physical group -> its nodes, 0-based, ascending
};

/// The boundary of a TetMesh, oriented outward.
struct BoundarySurface {
  std::vector<std::int32_t> nodes;  ///< Ns volume nodes on the boundary, ascending
  std::vector<std::array<std::int32_t, 3>>
      triangles;  ///< 0-based into `nodes`, counter-clockwise from outside
};

}  // namespace palpate::mesh
