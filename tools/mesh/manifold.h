// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace palpate::mesh {

using Triangle = std::array<std::int32_t, 3>;

/// A vertex whose triangles form several fans: not all of them hang together by edges at the vertex.
struct JoinedFans {
  std::int32_t vertex;
  std::vector<std::int32_t> triangles;  ///< one of each fan, the lowest, ascending
};

/// All such vertices, ascending. Holes, and edges in more than two triangles, do not make one.
/// @param triangles  T x 3, indices in [0, vertex_count)
/// Cost O(T) and the square of the triangles around each vertex.
[[nodiscard]] std::vector<JoinedFans> joinedFans(const std::vector<Triangle>& triangles,
                                                 std::size_t vertex_count);

/// First reason why triangles are not a closed, consistently oriented two-manifold, in words; nothing when
/// they are. An edge must lie in exactly two triangles that pass it in opposite directions, and the triangles
/// around a vertex must form one fan.
/// @param triangles     T x 3, indices in [0, vertex_count)
/// @param vertexName    how the message names a vertex
/// @param triangleName  how the message names a triangle
/// Cost O(T log T).
[[nodiscard]] std::optional<std::string> manifoldDefect(
    const std::vector<Triangle>& triangles, std::size_t vertex_count,
    const std::function<std::string(std::int32_t)>& vertexName,
    const std::function<std::string(std::int32_t)>& triangleName);

}  // namespace palpate::mesh
