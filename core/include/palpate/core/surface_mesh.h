// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "palpate/core/bounding_volumes.h"
#include "palpate/core/contact_point.h"
#include "palpate/core/model_view.h"
#include "palpate/core/types.h"

namespace palpate {

/// The point of a surface that lies nearest to a query point.
struct NearestPoint {
  ContactPoint s;
  Vec3 position = Vec3::Zero();  ///< X(s), m
  double signed_distance{0.0};   ///< m, negative inside the organ
};

/// The rest surface: positions, normals, nearest points, and where the organ can be touched (DESIGN 3.1).
/// Borrows the arrays of the view; built before the loop, then const.
class SurfaceMesh {
 public:
  /// Builds normals and the bounding volume hierarchy. O(T log T), allocates.
  /// @throw std::invalid_argument naming the triangle, when one has no area, repeats a node, or the surface
  /// is not
  ///        closed and consistently oriented (then inside and outside would mean nothing)
  explicit SurfaceMesh(const ModelView& view);

  [[nodiscard]] int nodes() const noexcept { return static_cast<int>(positions_.size() / 3); }
  [[nodiscard]] int triangles() const noexcept { return static_cast<int>(triangles_.size() / 3); }

  /// Nearest point of the rest surface to c; sign by the angle-weighted pseudonormal of the feature (face,
  /// edge or vertex) it lies on, which is right for any closed surface, thin ones included.
  /// @param c  finite, in W, m. Cost O(log T) typically, O(T) at worst. Real-time: yes.
  [[nodiscard]] NearestPoint closestPoint(const Vec3& c) const noexcept PALPATE_NONBLOCKING;

  /// X(s), m. Real-time: yes.
  [[nodiscard]] Vec3 position(const ContactPoint& s) const noexcept PALPATE_NONBLOCKING;
  /// Outward unit normal, the nodes' angle-weighted normals mixed barycentrically: continuous over edges and
  /// nodes. Real-time: yes.
  [[nodiscard]] Vec3 normal(const ContactPoint& s) const noexcept PALPATE_NONBLOCKING;
  /// Outward unit normal of a surface node.
  [[nodiscard]] const Vec3& nodeNormal(int node) const noexcept PALPATE_NONBLOCKING {
    return node_normals_[static_cast<std::size_t>(node)];
  }
  /// The contact point that lies on a surface node.
  [[nodiscard]] ContactPoint atNode(int node) const noexcept PALPATE_NONBLOCKING;

  /// True when at least one of the triangle's nodes belongs to the accessible group. Real-time: yes.
  [[nodiscard]] bool accessible(int triangle) const noexcept PALPATE_NONBLOCKING;
  /// The contact positions that answer for s, and their weights. Real-time: yes.
  [[nodiscard]] PositionMix mix(const ContactPoint& s) const noexcept PALPATE_NONBLOCKING;

  /// A field given at the nodes, at s. @param field  [Ns][3]. Real-time: yes.
  [[nodiscard]] Vec3 interpolate(std::span<const float> field,
                                 const ContactPoint& s) const noexcept PALPATE_NONBLOCKING;

 private:
  [[nodiscard]] Vec3 nodePosition(std::int32_t node) const noexcept;
  void buildNormals();
  void buildEdgeNormals();

  std::span<const double> positions_;
  std::span<const std::int32_t> triangles_;
  std::span<const std::int32_t> position_of_node_;
  std::span<const std::uint8_t> position_accessible_;
  std::vector<Vec3> face_normals_;                 ///< [T] unit
  std::vector<std::array<Vec3, 3>> edge_normals_;  ///< [T][3] edge k lies opposite to node k
  std::vector<Vec3> node_normals_;                 ///< [Ns] unit, angle-weighted
  std::vector<std::int32_t> triangle_at_node_;     ///< [Ns] any triangle that has the node
  BoundingVolumes tree_;
};

}  // namespace palpate
