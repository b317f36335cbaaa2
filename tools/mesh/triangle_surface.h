// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace palpate::mesh {

/// A surface of triangles from a file, before it is filled. Messages name triangle and vertex by
/// position in the file, counted from 1.
struct TriangleSurface {
  std::vector<Eigen::Vector3d> vertices;               ///< m (after scaling)
  std::vector<std::int64_t> vertex_tags;               ///< vertex number in the file, from 1
  std::vector<std::array<std::int32_t, 3>> triangles;  ///< 0-based into vertices
  std::vector<std::int64_t> triangle_tags;             ///< facet or face number in the file, from 1
  /// 0-based triangles, ascending, by the name of the group or material that the file gives them; of .obj files only.
  std::map<std::string, std::vector<std::int32_t>> groups{};
};

/// The volume that outward triangles enclose, m^3; of inward ones it is negative. A hole counts as closed by a cone to
/// the middle of the bounding box.
[[nodiscard]] double enclosedVolume(const TriangleSurface& surface);

/// m^2
[[nodiscard]] double areaOf(const TriangleSurface& surface);

}  // namespace palpate::mesh
