// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "tools/mesh/manifold.h"
#include "tools/mesh/surface_defects.h"
#include "tools/mesh/triangle_crossing.h"

namespace palpate::mesh {
namespace {

using Vec3 = Eigen::Vector3d;

constexpr double kTouch = 1e-9;  // of the surface's size: closer counts as touching

// Shared corners first; otherwise each triangle keeps its own order.
std::size_t sharedFirst(Triangle& a, Triangle& b) {
  std::size_t shared = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto twin = std::find(b.begin() + static_cast<std::ptrdiff_t>(shared), b.end(), a[i]);
    if (twin == b.end()) continue;
    std::iter_swap(b.begin() + static_cast<std::ptrdiff_t>(shared), twin);
    std::swap(a[shared++], a[i]);
  }
  return shared;
}

bool neighboursCross(const TriangleSurface& surface, std::size_t i, std::size_t j, double tolerance) {
  Triangle a = surface.triangles[i];
  Triangle b = surface.triangles[j];
  const std::size_t shared = sharedFirst(a, b);
  const auto at = [&](std::int32_t v) -> const Vec3& {
    return surface.vertices[static_cast<std::size_t>(v)];
  };
  const TrianglePoints p{at(a[0]), at(a[1]), at(a[2])};
  const TrianglePoints q{at(b[0]), at(b[1]), at(b[2])};
  if (shared == 0) return trianglesMeet(p, q, tolerance);
  if (shared == 1)
    return segmentMeetsTriangle(p[1], p[2], q, tolerance) || segmentMeetsTriangle(q[1], q[2], p, tolerance);
  if (shared == 3) return false;  // a twin, which is a defect of its own
  // A shared edge: only triangles folded flat onto each other overlap.
  const Vec3 edge = p[1] - p[0];
  const Vec3 n = edge.cross(q[2] - p[0]).normalized();
  return std::abs(n.dot(p[2] - p[0])) <= tolerance && n.dot(edge.cross(p[2] - p[0])) > 0;
}

bool canCross(const TriangleSurface& surface, const Triangle& t) {
  const bool finite = std::all_of(t.begin(), t.end(), [&](std::int32_t v) {
    return surface.vertices[static_cast<std::size_t>(v)].allFinite();
  });
  return finite && t[0] != t[1] && t[1] != t[2] && t[2] != t[0];
}

}  // namespace

std::vector<std::pair<std::size_t, std::size_t>> selfIntersections(const TriangleSurface& surface,
                                                                   std::size_t most) {
  std::vector<Eigen::AlignedBox3d> boxes(surface.triangles.size());
  std::vector<std::size_t> order;
  Eigen::AlignedBox3d all;
  for (std::size_t t = 0; t < boxes.size(); ++t) {
    if (!canCross(surface, surface.triangles[t])) continue;
    for (const auto v : surface.triangles[t]) boxes[t].extend(surface.vertices[static_cast<std::size_t>(v)]);
    all.extend(boxes[t]);
    order.push_back(t);
  }
  const double tolerance = kTouch * all.diagonal().norm();
  std::sort(order.begin(), order.end(),
            [&](auto a, auto b) { return boxes[a].min().x() < boxes[b].min().x(); });
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  std::vector<std::size_t> active;  // triangles whose x range reaches the current one
  for (const std::size_t t : order) {
    if (pairs.size() >= most) break;
    std::erase_if(active, [&](std::size_t a) { return boxes[a].max().x() < boxes[t].min().x() - tolerance; });
    for (const std::size_t a : active) {
      const bool apart = (boxes[a].min().array() > boxes[t].max().array() + tolerance).any() ||
                         (boxes[t].min().array() > boxes[a].max().array() + tolerance).any();
      if (!apart && neighboursCross(surface, a, t, tolerance)) pairs.emplace_back(std::minmax(a, t));
    }
    active.push_back(t);
  }
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

}  // namespace palpate::mesh
