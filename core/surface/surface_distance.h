// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "core/base/contact_point.h"
#include "core/base/types.h"

namespace palpate {

/// A triangulated surface, and which triangles meet at a node. Of quadratic elements four triangles make a face, and points of
/// the surface are points of faces: docs/design.md, Elements. Owns its numbers; const once built.
class SurfaceGraph {
 public:
  /// A triangle in its plane, seen from one corner C: the other two, A and B, on the x axis.
  struct Corner {
    double to_a, to_b;  ///< |CA|, |CB|, m
    double base;        ///< |AB|, m: A at (0, 0), B at (base, 0)
    double x, height;   ///< C, m
  };

  /// @param positions  [Ns][3] m  @param triangles  [T][3] indices of nodes, in range
  /// @param faces  [T][3] or [T / 4][3] corners, in the order of the triangles; empty: the triangles. O(Ns + T), allocates.
  SurfaceGraph(std::span<const double> positions, std::span<const std::int32_t> triangles,
               std::span<const std::int32_t> faces = {});

  [[nodiscard]] int nodes() const noexcept { return static_cast<int>(positions_.size()); }
  [[nodiscard]] int triangles() const noexcept { return static_cast<int>(triangles_.size() / 3); }
  [[nodiscard]] const Vec3& position(std::int32_t node) const noexcept {
    return positions_[static_cast<std::size_t>(node)];
  }
  /// Nodes of a triangle, 3.
  [[nodiscard]] std::span<const std::int32_t> triangle(std::int32_t t) const noexcept {
    return std::span(triangles_).subspan(3 * static_cast<std::size_t>(t), 3);
  }
  [[nodiscard]] int faces() const noexcept { return static_cast<int>(faces_.size() / 3); }
  /// Corners of a face, 3.
  [[nodiscard]] std::span<const std::int32_t> face(std::int32_t f) const noexcept {
    return std::span(faces_).subspan(3 * static_cast<std::size_t>(f), 3);
  }
  /// The node as a point of a face.
  [[nodiscard]] ContactPoint atNode(std::int32_t node) const noexcept;
  /// Corner k of a triangle; A and B are the corners k + 1 and k + 2, modulo 3.
  [[nodiscard]] const Corner& corner(std::int32_t t, std::size_t k) const noexcept {
    return corners_[3 * static_cast<std::size_t>(t) + k];
  }
  /// Triangles that a node belongs to, in rising order.
  [[nodiscard]] std::span<const std::int32_t> trianglesOf(std::int32_t node) const noexcept;
  /// The lumped rest area of each node, [Ns], m^2: a third of each of its triangles.
  [[nodiscard]] std::vector<double> lumpedAreas() const;
  /// A_i, the integral of each node's shape function over the surface, [Ns], m^2: of linear elements its lumped area, of
  /// quadratic ones a third of each face in the middles of its edges.             docs/design.md, Symbols, Elements
  [[nodiscard]] std::vector<double> loadAreas() const;

 private:
  std::vector<Vec3> positions_;
  std::vector<std::int32_t> triangles_, faces_;
  std::vector<Corner> corners_;      ///< [T][3]
  std::vector<std::int32_t> first_;  ///< [Ns + 1] into around_
  std::vector<std::int32_t> around_;
};

/// Distances along a surface, by a front that unfolds one triangle at a time: exact on a flat (or developable)
/// surface where the shortest path crosses the edge it is unfolded over, else the shorter way along an edge.
/// Of contact patches: through space a ball reaches the other side of a thin lobe.      docs/design.md, Parts
/// Holds the memory of the search; one per thread. Borrows the graph. Not real-time (allocates).
class SurfaceFront {
 public:
  using NodeDistance = std::pair<std::int32_t, double>;  ///< node, m

  explicit SurfaceFront(const SurfaceGraph& graph);

  /// The nodes nearer to s than `bound`, nearest first. @param bound  m
  /// @return valid until the next call. Cost O(k log k) for k nodes.
  [[nodiscard]] const std::vector<NodeDistance>& from(const ContactPoint& s, double bound);

 private:
  enum class State : std::uint8_t { kUnseen, kOffered, kSettled };

  using Entry = std::pair<double, std::int32_t>;  // of the queue: distance, node

  void offer(std::int32_t node, double distance);
  void spread(std::int32_t triangle, std::int32_t node);
  void forget();
  void rise(std::size_t place, const Entry& entry);
  [[nodiscard]] Entry takeNearest();

  const SurfaceGraph& graph_;
  double bound_{0.0};
  std::vector<double> distance_;    ///< [Ns] tentative, then settled
  std::vector<State> state_;        ///< [Ns]
  std::vector<std::int32_t> seen_;  ///< whose state is to be forgotten
  std::vector<NodeDistance> settled_;
  std::vector<Entry> queue_;        ///< a heap; each offered node once, so that a nearer offer moves it
  std::vector<std::size_t> place_;  ///< [Ns] of offered nodes, in the queue
};

}  // namespace palpate
