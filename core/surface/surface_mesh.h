// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/contact_point.h"
#include "core/base/types.h"
#include "core/data/model_view.h"
#include "core/surface/bounding_volumes.h"

namespace palpate {

/// The point of a surface that lies nearest to a query point.
struct NearestPoint {
  ContactPoint s;
  Vec3 position = Vec3::Zero();  ///< X(s), m
  double signed_distance{0.0};   ///< m, negative inside the organ
};

/// The surface at s as a contact feels it. xi are lengths along the tangents, m.
struct TangentFrame {
  Vec3 position = Vec3::Zero();  ///< X(s), m
  Vec3 normal = Vec3::Zero();    ///< n(s), interpolated
  Mat32 tangent;                 ///< orthonormal, normal to n(s)
  Mat32 along;                   ///< dX/dxi: in the triangle's plane, seen along n(s) equal to `tangent`
  Mat32 turning;                 ///< dn/dxi, 1/m, normal to n(s)
  Mat32 rates;                   ///< d lambda/dxi of the barycentric weights, 1/m
};

/// Whether a way over the surface may leave the accessible part.
enum class Reach { kAccessible, kEverywhere };

/// A point of the surface as its fields have it.
struct NodeMix {
  std::array<std::int32_t, 3> node;  ///< surface nodes, of one flat triangle
  std::array<double, 3> weight;      ///< sum 1
};

/// The rest surface: positions, normals, nearest points, and where the organ can be touched (docs/design.md, Contact). Its
/// triangles are the faces of the elements; of quadratic ones each is drawn as four, see partOf(), docs/design.md, Elements.
/// Borrows the arrays of the view; built before the loop, then const.
class SurfaceMesh {
 public:
  /// Builds normals and the bounding volume hierarchy. O(T log T), allocates.
  /// @throw std::invalid_argument naming the triangle, when one has no area, repeats a node, or the surface
  /// is not
  ///        closed and consistently oriented (then inside and outside would mean nothing)
  explicit SurfaceMesh(const ModelView& view);
  /// A surface without contact positions, divided from one that is sound: its parts are sound too. O(T).
  /// @param levels  how often faces were divided (face_points.h)  @param node_normals  [Ns] unit
  /// @param neighbours  [T] across the edge opposite to node k  @param reachable  [T] 1: an anchor may be there
  /// The spans are borrowed. @throw std::invalid_argument naming the triangle, when one has no area
  SurfaceMesh(std::span<const double> positions, std::span<const std::int32_t> triangles, int levels,
              std::vector<Vec3> node_normals, std::vector<std::array<std::int32_t, 3>> neighbours,
              std::vector<std::uint8_t> reachable);

  [[nodiscard]] int nodes() const noexcept { return static_cast<int>(positions_.size() / 3); }
  [[nodiscard]] int triangles() const noexcept { return static_cast<int>(triangles_.size() / 3); }
  /// [T] the triangles across the edges opposite to each one's nodes.
  [[nodiscard]] std::span<const std::array<std::int32_t, 3>> neighbours() const noexcept {
    return neighbours_;
  }

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
  /// accessible(), and each of the triangle's nodes has a contact position: an anchor may be there. Real-time: yes.
  [[nodiscard]] bool reachable(std::int32_t triangle) const noexcept PALPATE_NONBLOCKING;
  /// The contact positions that answer for s, and their weights. Real-time: yes.
  [[nodiscard]] PositionMix mix(const ContactPoint& s) const noexcept PALPATE_NONBLOCKING;

  /// Of frame(), what is at s: position, normal, `tangent`, `along`. Real-time: yes.
  [[nodiscard]] TangentFrame place(const ContactPoint& s) const noexcept PALPATE_NONBLOCKING;
  /// Position, normal and how they change at s. Real-time: yes.
  [[nodiscard]] TangentFrame frame(const ContactPoint& s) const noexcept PALPATE_NONBLOCKING;
  /// Goes from s over the surface, straight within triangles, unfolded at their edges.
  /// @param v  m, normal to n(s): what the way looks like from there. At most kMaxCrossings edges are crossed.
  /// @return false when the way ended earlier, at the border of what may be reached; s is there. Real-time: yes.
  [[nodiscard]] bool move(ContactPoint& s, const Vec3& v, Reach reach) const noexcept PALPATE_NONBLOCKING;
  static constexpr int kMaxCrossings = 32;
  /// The s near `nearest` that c lies straight above, c = X(s) + h n(s) with the interpolated normal n.
  /// @param[out] h  height, m, negative inside
  /// @return false, s and h as they were, where Newton's method does not end close by: beside a sharp concave
  /// edge or deep inside. Real-time: yes.
  [[nodiscard]] bool project(const Vec3& c, ContactPoint& s, double& h) const noexcept PALPATE_NONBLOCKING;

  /// Goes from s over the surface to where c is nearest, downhill all the way, so that s stays on its side of a thin part.
  /// @param farthest  of the way, m. At most 8 steps. Real-time: yes.
  void descend(const Vec3& c, double farthest, ContactPoint& s) const noexcept PALPATE_NONBLOCKING;

  /// Row k: the gradient of a triangle's barycentric weight k in its plane, 1/m. Real-time: yes.
  [[nodiscard]] Mat3 slopes(std::int32_t triangle) const noexcept PALPATE_NONBLOCKING;
  /// Rest positions of a triangle's nodes, m. Real-time: yes.
  [[nodiscard]] std::array<Vec3, 3> corners(std::int32_t triangle) const noexcept PALPATE_NONBLOCKING;
  /// From a point to the nearest of a triangle's corners and middles of edges, m. Real-time: yes.
  [[nodiscard]] double distanceToNodes(std::int32_t triangle,
                                       const Vec3& x) const noexcept PALPATE_NONBLOCKING;
  /// The nodes between which fields are linear at s, and their weights. Real-time: yes.
  [[nodiscard]] NodeMix nodesAt(const ContactPoint& s) const noexcept PALPATE_NONBLOCKING;
  /// Each of the triangle's nodes has a contact position. Real-time: yes.
  [[nodiscard]] bool complete(std::int32_t triangle) const noexcept PALPATE_NONBLOCKING;
  /// Asks the cache for what is read of a triangle and its nodes. Real-time: yes.
  void expect(std::int32_t triangle) const noexcept PALPATE_NONBLOCKING;

 private:
  [[nodiscard]] Vec3 nodePosition(std::int32_t node) const noexcept PALPATE_NONBLOCKING;
  [[nodiscard]] Vec3 mixedNormal(const ContactPoint& s) const noexcept PALPATE_NONBLOCKING;
  static constexpr double kLeastNormal = 1e-6;  // below, on a blade's edge, the nodes' normals cancel
  [[nodiscard]] double stepNearer(const Vec3& c, Vec3 v, ContactPoint& s) const noexcept PALPATE_NONBLOCKING;
  void crossEdge(ContactPoint& s, std::size_t edge, std::int32_t to,
                 Vec3& w) const noexcept PALPATE_NONBLOCKING;
  void buildFaceNormals();
  void buildNodeNormals();
  void placeMiddles();
  void findReachable();
  void findNeighbours();

  std::span<const double> positions_;
  std::span<const std::int32_t> triangles_;
  std::span<const std::int32_t>
      drawn_;  ///< flat: triangles_, or four for each of these; none of a surface without fields
  std::span<const std::int32_t> position_of_node_;
  std::span<const std::uint8_t> position_accessible_;
  std::vector<Vec3> face_normals_;                       ///< [T] unit
  std::vector<std::array<std::int32_t, 3>> neighbours_;  ///< [T][3] across the edge opposite to node k
  std::vector<Vec3> node_normals_;                       ///< [Ns] unit, angle-weighted
  std::vector<std::uint8_t> reachable_;                  ///< [T]
  std::vector<std::int32_t> triangle_at_node_;           ///< [Ns] any triangle that has the node
  BoundingVolumes tree_;
};

}  // namespace palpate
