// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "palpate/client/surface.h"

namespace palpate::client {

/// From a point to the nearest of the surface's triangles at rest, m. O(T). Real-time: no.
[[nodiscard]] double distanceTo(const Surface& surface, const device::Point& x);

/// How far from the surface a place may lie that means a point of it, m: Surface::contact_radius, or where an older server does
/// not say it the mean edge of the surface.
[[nodiscard]] double contactRadius(const Surface& surface);

}  // namespace palpate::client
