// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "core/base/types.h"

namespace palpate {

/// Which part of a triangle a nearest point lies on; edge k lies opposite to node k.
enum class TriangleFeature : std::uint8_t { kFace, kEdge0, kEdge1, kEdge2, kNode0, kNode1, kNode2 };

/// Nearest point on one triangle.
struct TriangleHit {
  std::array<double, 3> barycentric{};
  TriangleFeature feature{TriangleFeature::kFace};
  Vec3 point = Vec3::Zero();     ///< m
  double squared_distance{0.0};  ///< m^2
};

/// Nearest point of the triangle a, b, c to p. Real-time: yes.
[[nodiscard]] TriangleHit closestOnTriangle(const Vec3& p, const Vec3& a, const Vec3& b,
                                            const Vec3& c) noexcept PALPATE_NONBLOCKING;

}  // namespace palpate
