// SPDX-License-Identifier: Apache-2.0
#include "tools/mesh/triangle_crossing.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace palpate::mesh {
namespace {

using Vec3 = Eigen::Vector3d;

// x lies in the triangle's plane; n is the unit normal.
bool inTriangle(const Vec3& x, const TrianglePoints& t, const Vec3& n, double tolerance) {
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3 edge = t[(i + 1) % 3] - t[i];
    if (n.dot(edge.cross(x - t[i])) < -tolerance * edge.norm()) return false;
  }
  return true;
}

// Whether segments pq and rs, in the plane of normal n, cross: each has its ends on both sides of the other.
bool cross(const Vec3& p, const Vec3& q, const Vec3& r, const Vec3& s, const Vec3& n) {
  const auto side = [&n](const Vec3& a, const Vec3& b, const Vec3& x) { return n.dot((b - a).cross(x - a)); };
  return side(p, q, r) * side(p, q, s) < 0 && side(r, s, p) * side(r, s, q) < 0;
}

}  // namespace

bool segmentMeetsTriangle(const Vec3& p, const Vec3& q, const TrianglePoints& t, double tolerance) {
  const Vec3 n = (t[1] - t[0]).cross(t[2] - t[0]).normalized();
  const double above_p = n.dot(p - t[0]);
  const double above_q = n.dot(q - t[0]);
  if (std::min(above_p, above_q) > tolerance || std::max(above_p, above_q) < -tolerance) return false;
  if (std::abs(above_p - above_q) > 2 * tolerance) {
    const double fraction = std::clamp(above_p / (above_p - above_q), 0.0, 1.0);
    return inTriangle(p + fraction * (q - p), t, n, tolerance);
  }
  if (inTriangle(p, t, n, tolerance) || inTriangle(q, t, n, tolerance)) return true;
  return cross(p, q, t[0], t[1], n) || cross(p, q, t[1], t[2], n) || cross(p, q, t[2], t[0], n);
}

bool trianglesMeet(const TrianglePoints& a, const TrianglePoints& b, double tolerance) {
  for (std::size_t i = 0; i < 3; ++i) {
    if (segmentMeetsTriangle(a[i], a[(i + 1) % 3], b, tolerance)) return true;
    if (segmentMeetsTriangle(b[i], b[(i + 1) % 3], a, tolerance)) return true;
  }
  return false;
}

}  // namespace palpate::mesh
