// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/base/types.h"

namespace palpate::bench {

struct Ellipsoid {
  std::vector<Vec3> nodes;                             ///< m; the first is the top, the last the bottom
  std::vector<std::array<std::int32_t, 3>> triangles;  ///< counter-clockwise from outside, closed
};

/// A closed surface with a given number of nodes at about equal distances: rings of latitude, each ring
/// joined to the next. @param[in] nodes  at least 20, @param[in] semi_axes  m
[[nodiscard]] Ellipsoid ellipsoid(int nodes, const Vec3& semi_axes);

}  // namespace palpate::bench
