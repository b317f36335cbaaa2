// SPDX-License-Identifier: Apache-2.0
#include "core/surface/triangle_hit.h"

#include <algorithm>

namespace palpate {

namespace {

using Corners = std::array<Vec3, 3>;

TriangleHit hitAt(const Vec3& p, const Corners& corner, const std::array<double, 3>& barycentric,
                  TriangleFeature feature) noexcept PALPATE_NONBLOCKING {
  TriangleHit hit;
  hit.barycentric = barycentric;
  hit.feature = feature;
  hit.point = barycentric[0] * corner[0] + barycentric[1] * corner[1] + barycentric[2] * corner[2];
  hit.squared_distance = (p - hit.point).squaredNorm();
  return hit;
}

/// Nearest point on the edge opposite to corner k: how far along it, 0 to 1, and how far from p.
struct EdgePoint {
  double t;
  double squared_distance;
};

EdgePoint closestOnEdge(const Vec3& p, const Corners& corner, std::size_t k) noexcept PALPATE_NONBLOCKING {
  const Vec3& from = corner[(k + 1) % 3];
  const Vec3 edge = corner[(k + 2) % 3] - from, gap = p - from;
  const double t = std::clamp(gap.dot(edge) / edge.squaredNorm(), 0.0, 1.0);
  return {t, (gap - t * edge).squaredNorm()};
}

TriangleHit hitOnEdge(const Vec3& p, const Corners& corner, std::size_t k,
                      double t) noexcept PALPATE_NONBLOCKING {
  const std::size_t i = (k + 1) % 3, j = (k + 2) % 3;
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
  EdgePoint best = closestOnEdge(p, corner, 0);
  std::size_t on = 0;
  for (std::size_t k = 1; k < 3; ++k) {
    const EdgePoint other = closestOnEdge(p, corner, k);
    if (!(other.squared_distance < best.squared_distance)) continue;
    best = other;
    on = k;
  }
  return hitOnEdge(p, corner, on, best.t);
}

}  // namespace palpate
