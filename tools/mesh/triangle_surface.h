// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace palpate::mesh {

/// A surface of triangles from a file, before it is filled. Messages name triangle and vertex by
/// position in the file, counted from 1.
struct TriangleSurface {
  std::vector<Eigen::Vector3d> vertices;               ///< m (after scaling)
  std::vector<std::int64_t> vertex_tags;               ///< vertex number in the file, from 1
  std::vector<std::array<std::int32_t, 3>> triangles;  ///< 0-based into vertices
  std::vector<std::int64_t> triangle_tags;             ///< facet or face number in the file, from 1
};

/// Refuses a surface that does not bound one solid: non-finite vertices, degenerate triangles, open or
/// non-manifold edges, several parts, triangles that cut each other. Reverses all triangles when all of them
/// face inward.
/// @throw MeshError naming the triangle
/// Cost O(T log T) plus the pairs of triangles whose boxes overlap along x. Real-time: no.
void checkSurface(TriangleSurface& surface);

/// First two triangles (0-based) that cut or overlap outside their shared corners and edges.
[[nodiscard]] std::optional<std::pair<std::size_t, std::size_t>> firstSelfIntersection(
    const TriangleSurface& surface);

}  // namespace palpate::mesh
