// SPDX-License-Identifier: Apache-2.0
#include "palpate/client/place.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace palpate::client {
namespace {

using device::Point;

Point cross(const Point& a, const Point& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

double toSegment(const Point& x, const Point& a, const Point& b) {
  const Point edge = b - a;
  const double square = dot(edge, edge);
  const double t = square > 0.0 ? std::clamp(dot(x - a, edge) / square, 0.0, 1.0) : 0.0;
  return length(x - (a + t * edge));
}

/// To the plane where x lies above the triangle, else to its edges.
double toTriangle(const Point& x, const std::array<Point, 3>& corner) {
  const Point normal = cross(corner[1] - corner[0], corner[2] - corner[0]);
  const double size = length(normal);
  double nearest = std::numeric_limits<double>::infinity();
  bool above = size > 0.0;
  for (std::size_t k = 0; k < 3; ++k) {
    const Point &a = corner[k], &b = corner[(k + 1) % 3];
    above = above && dot(cross(b - a, x - a), normal) >= 0.0;
    nearest = std::min(nearest, toSegment(x, a, b));
  }
  return above ? std::abs(dot(x - corner[0], normal)) / size : nearest;
}

}  // namespace

double distanceTo(const Surface& surface, const Point& x) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const auto& t : surface.triangles)
    nearest = std::min(
        nearest, toTriangle(x, {surface.positions[t[0]], surface.positions[t[1]], surface.positions[t[2]]}));
  return nearest;
}

double contactRadius(const Surface& surface) {
  if (surface.contact_radius > 0.0) return surface.contact_radius;
  double edges = 0.0;
  for (const auto& t : surface.triangles)
    for (std::size_t k = 0; k < 3; ++k)
      edges += length(surface.positions[t[k]] - surface.positions[t[(k + 1) % 3]]);
  return edges / (3.0 * static_cast<double>(surface.triangles.size()));
}

}  // namespace palpate::client
