// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/contact_point.h"
#include "core/base/types.h"

namespace palpate {

/// Where a smooth function of the contact position is known: at the contact positions, and in the middle of each edge between
/// two of them that belongs to a complete triangle, one whose nodes all have a position. Positions come first, in their
/// order; then edges, by their smaller and then their larger position.                  docs/design.md, Parts
class SmoothPlaces {
 public:
  /// A place as one of the triangles round it has it.
  struct View {
    ContactPoint s;
    double share;  ///< of the triangle's area in that of all views
    Mat3 slopes;   ///< row k: gradient of barycentric weight k, 1/m
  };

  /// @param positions  [Ns][3] m  @param triangles  [T][3]  @param position_of_node  [Ns] or -1; M of them
  SmoothPlaces(std::span<const double> positions, std::span<const std::int32_t> triangles,
               std::span<const std::int32_t> position_of_node);

  [[nodiscard]] std::size_t size() const noexcept { return first_.size() - 1; }
  /// The complete triangles round a place; of a position that has none, any one triangle.
  [[nodiscard]] std::span<const View> views(std::size_t place) const noexcept {
    return std::span(views_).subspan(first_[place], first_[place + 1] - first_[place]);
  }
  /// The places of a triangle: of its nodes, then of the edges opposite to them. -1 in a triangle that is not complete.
  [[nodiscard]] const std::array<std::int32_t, 6>& of(std::int32_t triangle) const noexcept {
    return of_triangle_[static_cast<std::size_t>(triangle)];
  }

 private:
  std::vector<std::size_t> first_;                        // [size + 1] into views_
  std::vector<View> views_;                               // place by place
  std::vector<std::array<std::int32_t, 6>> of_triangle_;  // [T]
};

}  // namespace palpate
