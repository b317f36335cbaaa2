// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <queue>
#include <span>
#include <utility>
#include <vector>

#include "core/base/contact_point.h"
#include "core/base/types.h"

namespace palpate {

/// A triangulated surface, and which triangles meet at a node. Owns its numbers; const once built.
class SurfaceGraph {
 public:
  /// A triangle in its plane, seen from one corner C: the other two, A and B, on the x axis.
  struct Corner {
    double to_a, to_b;  ///< |CA|, |CB|, m
    double base;        ///< |AB|, m: A at (0, 0), B at (base, 0)
    double x, height;   ///< C, m
  };

  /// @param positions  [Ns][3] m  @param triangles  [T][3] indices of nodes, in range. O(Ns + T), allocates.
  SurfaceGraph(std::span<const double> positions, std::span<const std::int32_t> triangles);

  [[nodiscard]] int nodes() const noexcept { return static_cast<int>(positions_.size()); }
  [[nodiscard]] int triangles() const noexcept { return static_cast<int>(triangles_.size() / 3); }
  [[nodiscard]] const Vec3& position(std::int32_t node) const noexcept {
    return positions_[static_cast<std::size_t>(node)];
  }
  /// Nodes of a triangle, 3.
  [[nodiscard]] std::span<const std::int32_t> triangle(std::int32_t t) const noexcept {
    return std::span(triangles_).subspan(3 * static_cast<std::size_t>(t), 3);
  }
  /// Corner k of a triangle; A and B are the corners k + 1 and k + 2, modulo 3.
  [[nodiscard]] const Corner& corner(std::int32_t t, std::size_t k) const noexcept {
    return corners_[3 * static_cast<std::size_t>(t) + k];
  }
  /// Triangles that a node belongs to, in rising order.
  [[nodiscard]] std::span<const std::int32_t> trianglesOf(std::int32_t node) const noexcept;
  /// A_i, the lumped rest area of each node, [Ns], m^2: a third of each of its triangles.   docs/design.md, Symbols
  [[nodiscard]] std::vector<double> lumpedAreas() const;

 private:
  std::vector<Vec3> positions_;
  std::vector<std::int32_t> triangles_;
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

  void offer(std::int32_t node, double distance);
  void spread(std::int32_t triangle, std::int32_t node);
  void forget();

  using Entry = std::pair<double, std::int32_t>;
  const SurfaceGraph& graph_;
  double bound_{0.0};
  std::vector<double> distance_;    ///< [Ns] tentative, then settled
  std::vector<State> state_;        ///< [Ns]
  std::vector<std::int32_t> seen_;  ///< whose state is to be forgotten
  std::vector<NodeDistance> settled_;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue_;
};

}  // namespace palpate
