// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace palpate::mesh {

/// A volume mesh of tetrahedra for the solver: every node belongs to a tetrahedron, every tetrahedron has positive
/// volume (nodes 1, 2, 3 counter-clockwise seen from outside node 0's opposite). Linear ones have four nodes, quadratic
/// ones ten and straight edges.
struct TetMesh {
  std::vector<Eigen::Vector3d> nodes;   ///< N rest positions X, m
  std::vector<std::int64_t> node_tags;  ///< N numbers of the nodes in the mesh file, 1-based there
  std::vector<std::array<std::int32_t, 4>> tetrahedra;  ///< T x 4 corners, 0-based into nodes
  std::vector<std::array<std::int32_t, 6>>
      midsides;  ///< T x 6, nodes in the middle of kTetEdges; empty: linear elements
  std::vector<std::int64_t> tetrahedron_tags;  ///< T numbers in the mesh file
  std::map<std::string, std::vector<std::int32_t>>
      groups;  ///< physical group -> its nodes, 0-based, ascending
  std::map<std::string, std::vector<std::int32_t>>
      regions;  ///< physical group of tetrahedra -> these, 0-based, ascending

  [[nodiscard]] bool isQuadratic() const noexcept { return !midsides.empty(); }
};

/// The boundary of a TetMesh, oriented outward.
struct BoundarySurface {
  std::vector<std::int32_t> nodes;  ///< Ns volume nodes on the boundary, ascending
  /// Flat, 0-based into `nodes`, counter-clockwise from outside. Of quadratic elements four for each face, see splitFace().
  std::vector<std::array<std::int32_t, 3>> triangles;
  std::vector<std::array<std::int32_t, 3>>
      faces;  ///< the corners of the elements' faces, in the order of triangles
};

/// Corners of the six edges of a tetrahedron, in the order in which VTK and CalculiX number mid-side nodes.
inline constexpr std::array<std::array<int, 2>, 6> kTetEdges{
    {{0, 1}, {1, 2}, {0, 2}, {0, 3}, {1, 3}, {2, 3}}};

/// The four flat triangles of a face: at its corners, then the one between, whose node k lies across from corner k.
/// @param corner, middle  nodes; middle[k] between corners k and k + 1
[[nodiscard]] constexpr std::array<std::array<std::int32_t, 3>, 4> splitFace(
    const std::array<std::int32_t, 3>& corner, const std::array<std::int32_t, 3>& middle) noexcept {
  return {{{corner[0], middle[0], middle[2]},
           {middle[0], corner[1], middle[1]},
           {middle[2], middle[1], corner[2]},
           {middle[1], middle[2], middle[0]}}};
}

}  // namespace palpate::mesh
