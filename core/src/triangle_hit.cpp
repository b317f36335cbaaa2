// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "palpate/core/bounding_volumes.h"

namespace palpate {

namespace {

using Corners = std::array<Vec3, 3>;

TriangleHit hitAt(const Vec3& p, const Corners& corner, const std::array<double, 3>& barycentric,
                  TriangleFeature feature) noexcept {
  TriangleHit hit;
  hit.barycentric = barycentric;
  hit.feature = feature;
  hit.point = barycentric[0] * corner[0] + barycentric[1] * corner[1] + barycentric[2] * corner[2];
  hit.squared_distance = (p - hit.point).squaredNorm();
  return hit;
}

/// Nearest point on the edge opposite to corner k.
TriangleHit closestOnEdge(const Vec3& p, const Corners& corner, std::size_t k) noexcept {
  const std::size_t i = (k + 1) % 3, j = (k + 2) % 3;
  const Vec3 edge = corner[j] - corner[i];
  const double t = std::clamp((p - corner[i]).dot(edge) / edge.squaredNorm(), 0.0, 1.0);
  std::array<double, 3> barycentric{};
  barycentric[i] = 1.0 - t;
  barycentric[j] = t;
  const auto base = static_cast<std::size_t>(TriangleFeature::kEdge0);
  const auto node = static_cast<std::size_t>(TriangleFeature::kNode0);
  const std::size_t feature = t <= 0.0 ? node + i : (t >= 1.0 ? node + j : base + k);
  return hitAt(p, corner, barycentric, static_cast<TriangleFeature>(feature));
}

}  // namespace

TriangleHit closestOnTriangle(const Vec3& p, const Vec3& a, const Vec3& b,
                              const Vec3& c) noexcept PALPATE_NONBLOCKING {
  const Corners corner{a, b, c};
  const Vec3 normal = (b - a).cross(c - a);
  const double area2 = normal.squaredNorm();
  std::array<double, 3> weight{};
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3& from = corner[(k + 1) % 3];
    weight[k] = (corner[(k + 2) % 3] - from).cross(p - from).dot(normal) / area2;
  }
  if (weight[0] > 0.0 && weight[1] > 0.0 && weight[2] > 0.0)
    return hitAt(p, corner, weight, TriangleFeature::kFace);
  // Outside the prism over the triangle the nearest point lies on an edge, not always on one whose weight is
  // negative alone (obtuse corners): the nearest of all three is right in every case.
  TriangleHit best = closestOnEdge(p, corner, 0);
  for (std::size_t k = 1; k < 3; ++k) {
    const TriangleHit hit = closestOnEdge(p, corner, k);
    if (hit.squared_distance < best.squared_distance) best = hit;
  }
  return best;
}

}  // namespace palpate
