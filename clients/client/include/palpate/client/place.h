// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "palpate/client/surface.h"

namespace palpate::client {

/// From a point to the nearest of the surface's triangles at rest, m. O(T). Real-time: no.
[[nodiscard]] double distanceTo(const Surface& surface, const device::Point& x);

/// The least distanceTo() along a path, m, at most 0.1 mm above the true one; infinite for an empty path. A point that cannot be
/// nearer by more than that, seen from the last one that was looked at, is passed over: O(T) per 0.1 mm of the path.
/// @param[in] path      a range  @param[in] point_of  of an element of it: a device::Point, m
template <class Range, class PointOf>
[[nodiscard]] double nearestOf(const Surface& surface, const Range& path, PointOf point_of) {
  constexpr double kTolerance = 1e-4;  // m
  double nearest = std::numeric_limits<double>::infinity(), last = nearest;
  device::Point looked_at{};
  for (const auto& each : path) {
    const device::Point& x = point_of(each);
    if (std::isfinite(last) && last - length(x - looked_at) >= nearest - kTolerance) continue;
    looked_at = x;
    last = distanceTo(surface, x);
    nearest = std::min(nearest, last);
  }
  return nearest;
}

/// How far from the surface a place may lie that means a point of it, m: Surface::contact_radius, or where an older server does
/// not say it the mean edge of the surface.
[[nodiscard]] double contactRadius(const Surface& surface);

}  // namespace palpate::client
