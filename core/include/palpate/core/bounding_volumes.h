// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "palpate/core/types.h"

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

/// A binary tree of boxes over triangles, in one flat array: children halve the number of triangles, so that
/// the depth is at most 32 and the traversal's stack has a fixed size.
class BoundingVolumes {
 public:
  BoundingVolumes() = default;
  /// @param positions [Ns][3], @param triangles [T][3], indices checked by the caller; both borrowed.
  BoundingVolumes(std::span<const double> positions, std::span<const std::int32_t> triangles);

  struct Hit {
    std::int32_t triangle{-1};
    TriangleHit where;
  };
  /// Nearest triangle to a finite p. Allocates nothing. Real-time: yes.
  [[nodiscard]] Hit closest(const Vec3& p) const noexcept PALPATE_NONBLOCKING;

 private:
  struct Box {
    std::array<double, 3> low{};
    std::array<double, 3> high{};
    std::int32_t first{0};  ///< leaf: first in order_; inner: index of the right child (the left one follows)
    std::int32_t count{0};  ///< leaf: triangles; inner: 0
  };

  void build(std::int32_t begin, std::int32_t end, std::span<const Vec3> centres);
  [[nodiscard]] Box boxOf(std::int32_t begin, std::int32_t end) const;
  [[nodiscard]] double squaredDistance(const Box& box, const Vec3& p) const noexcept;
  void visitLeaf(const Box& box, const Vec3& p, Hit& best) const noexcept;
  [[nodiscard]] Vec3 corner(std::int32_t triangle, int k) const noexcept;

  std::span<const double> positions_;
  std::span<const std::int32_t> triangles_;
  std::vector<std::int32_t> order_;
  std::vector<Box> boxes_;
};

}  // namespace palpate
