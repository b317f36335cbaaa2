// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>

namespace palpate::mesh {

using TrianglePoints = std::array<Eigen::Vector3d, 3>;

/// Whether segment pq meets a triangle, ends and rim included, up to `tolerance` (m). Segments in the
/// triangle's plane are compared within that plane.
[[nodiscard]] bool segmentMeetsTriangle(const Eigen::Vector3d& p, const Eigen::Vector3d& q,
                                        const TrianglePoints& triangle, double tolerance);

/// Whether two triangles that share no corner have a point in common.
[[nodiscard]] bool trianglesMeet(const TrianglePoints& a, const TrianglePoints& b, double tolerance);

}  // namespace palpate::mesh
