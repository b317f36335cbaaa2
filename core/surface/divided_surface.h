// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/base/types.h"

namespace palpate {

/// A closed surface that is divided level by level, as face_points.h has it. Triangles know their neighbours, so that a level
/// costs O(T) and nothing is sorted.
struct DividedSurface {
  std::vector<Vec3> position;                          ///< [N] m
  std::vector<Vec3> normal;                            ///< [N] unit
  std::vector<Vec3> rest;                              ///< [N] the same points before any was rounded, m
  std::vector<std::array<std::int32_t, 3>> triangle;   ///< [T]
  std::vector<std::array<std::int32_t, 3>> neighbour;  ///< [T] across the edge opposite to node k

  /// Each triangle as four. A new node is the middle of the cubic over its edge (ContactSurface); normals are those of the new
  /// triangles, weighted by their angles. @return nothing where a new triangle has no area
  [[nodiscard]] std::optional<DividedSurface> divided() const;
};

}  // namespace palpate
