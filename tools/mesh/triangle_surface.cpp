// SPDX-License-Identifier: Apache-2.0
#include "tools/mesh/triangle_surface.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "tools/mesh/manifold.h"
#include "tools/mesh/mesh_error.h"
#include "tools/mesh/triangle_crossing.h"

namespace palpate::mesh {
namespace {

using Vec3 = Eigen::Vector3d;

constexpr double kTouch = 1e-9;        // of the surface's size: closer counts as touching
constexpr double kDegenerate = 1e-10;  // area over longest edge squared; 0.433 for a regular triangle

std::string triangleName(const TriangleSurface& surface, std::size_t t) {
  return "triangle " + std::to_string(surface.triangle_tags[t]);
}

TrianglePoints pointsOf(const TriangleSurface& surface, std::size_t t) {
  const auto& c = surface.triangles[t];
  return {surface.vertices[static_cast<std::size_t>(c[0])], surface.vertices[static_cast<std::size_t>(c[1])],
          surface.vertices[static_cast<std::size_t>(c[2])]};
}

Eigen::AlignedBox3d boxOf(const TrianglePoints& points) {
  Eigen::AlignedBox3d box;
  for (const auto& x : points) box.extend(x);
  return box;
}

void checkTriangles(const TriangleSurface& surface) {
  if (surface.triangles.empty()) throw MeshError("the surface holds no triangles");
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const TrianglePoints p = pointsOf(surface, t);
    if (!(p[0].allFinite() && p[1].allFinite() && p[2].allFinite())) {
      throw MeshError(triangleName(surface, t) + " has a coordinate that is not finite");
    }
    const double longest = std::max({(p[1] - p[0]).norm(), (p[2] - p[1]).norm(), (p[0] - p[2]).norm()});
    const double area = (p[1] - p[0]).cross(p[2] - p[0]).norm() / 2;
    if (!(area > kDegenerate * longest * longest)) throw MeshError(triangleName(surface, t) + " has no area");
  }
}

void checkManifold(const TriangleSurface& surface) {
  const auto vertex_name = [&](std::int32_t v) {
    return "vertex " + std::to_string(surface.vertex_tags[static_cast<std::size_t>(v)]);
  };
  const auto triangle_name = [&](std::int32_t t) {
    return triangleName(surface, static_cast<std::size_t>(t));
  };
  const auto defect = manifoldDefect(surface.triangles, surface.vertices.size(), vertex_name, triangle_name);
  if (defect) throw MeshError("the surface is not closed and manifold: " + *defect);
}

void checkOnePart(const TriangleSurface& surface) {
  std::vector<std::size_t> parent(surface.vertices.size());
  std::iota(parent.begin(), parent.end(), std::size_t{0});
  const auto root = [&](std::int32_t vertex) {
    auto v = static_cast<std::size_t>(vertex);
    while (parent[v] != v) v = parent[v] = parent[parent[v]];
    return v;
  };
  for (const auto& t : surface.triangles) {
    parent[root(t[1])] = root(t[0]);
    parent[root(t[2])] = root(t[0]);
  }
  const std::size_t first = root(surface.triangles.front()[0]);
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    if (root(surface.triangles[t][0]) == first) continue;
    throw MeshError("the surface is disconnected: " + triangleName(surface, t) + " is not joined to " +
                    triangleName(surface, 0));
  }
}

void turnOutward(TriangleSurface& surface) {
  double volume = 0;
  const Vec3 origin = surface.vertices[static_cast<std::size_t>(surface.triangles.front()[0])];
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const TrianglePoints p = pointsOf(surface, t);
    volume += (p[0] - origin).dot((p[1] - origin).cross(p[2] - origin)) / 6;
  }
  if (volume > 0) return;
  for (auto& t : surface.triangles) std::swap(t[1], t[2]);
}

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
  if (shared == 3) return true;
  // A shared edge: only triangles folded flat onto each other overlap.
  const Vec3 edge = p[1] - p[0];
  const Vec3 n = edge.cross(q[2] - p[0]).normalized();
  return std::abs(n.dot(p[2] - p[0])) <= tolerance && n.dot(edge.cross(p[2] - p[0])) > 0;
}

}  // namespace

std::optional<std::pair<std::size_t, std::size_t>> firstSelfIntersection(const TriangleSurface& surface) {
  std::vector<Eigen::AlignedBox3d> boxes;
  Eigen::AlignedBox3d all;
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    boxes.push_back(boxOf(pointsOf(surface, t)));
    all.extend(boxes.back());
  }
  const double tolerance = kTouch * all.diagonal().norm();
  std::vector<std::size_t> order(boxes.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](auto a, auto b) { return boxes[a].min().x() < boxes[b].min().x(); });
  std::vector<std::size_t> active;  // triangles whose x range reaches the current one
  for (const std::size_t t : order) {
    std::erase_if(active, [&](std::size_t a) { return boxes[a].max().x() < boxes[t].min().x() - tolerance; });
    for (const std::size_t a : active) {
      const bool apart = (boxes[a].min().array() > boxes[t].max().array() + tolerance).any() ||
                         (boxes[t].min().array() > boxes[a].max().array() + tolerance).any();
      if (!apart && neighboursCross(surface, a, t, tolerance)) return std::minmax(a, t);
    }
    active.push_back(t);
  }
  return std::nullopt;
}

void checkSurface(TriangleSurface& surface) {
  checkTriangles(surface);
  checkManifold(surface);
  checkOnePart(surface);
  turnOutward(surface);
  if (const auto pair = firstSelfIntersection(surface)) {
    throw MeshError("the surface cuts itself: " + triangleName(surface, pair->first) + " and " +
                    triangleName(surface, pair->second) + " intersect");
  }
}

}  // namespace palpate::mesh
