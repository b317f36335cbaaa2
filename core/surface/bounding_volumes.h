// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/types.h"
#include "core/surface/triangle_hit.h"

namespace palpate {

/// A tree of boxes over triangles, four children to a node, in one flat array. Children hold a quarter of the
/// triangles, so that the depth is at most 17 and the traversal's stack has a fixed size. Faces that were divided into four, level
/// by level (face_points.h), are the tree's lower part as they are: nothing is sorted there.
class BoundingVolumes {
 public:
  BoundingVolumes() = default;
  /// @param positions [Ns][3], @param triangles [T][3], indices checked by the caller; both borrowed.
  /// @param levels  how often faces were divided; O(T + F log F) for F faces
  BoundingVolumes(std::span<const double> positions, std::span<const std::int32_t> triangles, int levels = 0);

  struct Hit {
    std::int32_t triangle{-1};
    TriangleHit where;
  };
  /// Nearest triangle to a finite p; -1 when there is none at all. Allocates nothing. Real-time: yes.
  [[nodiscard]] Hit closest(const Vec3& p) const noexcept PALPATE_NONBLOCKING;

 private:
  static constexpr std::size_t kChildren = 4;
  /// The boxes of its children side by side, so that one comparison serves all four; floats, rounded outwards,
  /// take half the memory.
  struct Node {
    std::array<std::array<float, kChildren>, 3> low;
    std::array<std::array<float, kChildren>, 3> high;
    std::array<std::int32_t, kChildren>
        child;  ///< >= 0: a node; else ~triangle. An empty child has an infinitely far box
  };
  using Distances = std::array<double, kChildren>;

  struct Leaf {
    Vec3 centre;
    std::int32_t face;
  };
  struct Box;

  [[nodiscard]] Leaf leafOf(std::int32_t face) const;
  std::int32_t build(std::span<Leaf> leaves);
  std::int32_t buildFace(std::int32_t face, int levels);
  void adopt(std::int32_t self, std::size_t k, std::int32_t child);
  void adopt(std::int32_t self, std::size_t k, const Box& box, std::int32_t child);
  [[nodiscard]] static std::array<std::span<Leaf>, kChildren> divided(std::span<Leaf> leaves);
  [[nodiscard]] Box boxOfTriangle(std::int32_t triangle) const;
  [[nodiscard]] static Box boxOf(const Node& node);
  [[nodiscard]] static Distances squaredDistances(const Node& node,
                                                  const Vec3& p) noexcept PALPATE_NONBLOCKING;
  [[nodiscard]] TriangleHit hit(std::int32_t triangle, const Vec3& p) const noexcept PALPATE_NONBLOCKING;
  [[nodiscard]] Vec3 corner(std::int32_t triangle, int k) const noexcept PALPATE_NONBLOCKING;

  std::span<const double> positions_;
  std::span<const std::int32_t> triangles_;
  int levels_{0};
  std::vector<Node> nodes_;
};

}  // namespace palpate
