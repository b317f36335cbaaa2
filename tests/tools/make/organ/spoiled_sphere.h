// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <map>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "tools/mesh/triangle_surface.h"

namespace palpate::organ::test {

inline void numberFromOne(mesh::TriangleSurface& surface) {
  surface.vertex_tags.clear();
  surface.triangle_tags.clear();
  for (std::size_t i = 0; i < surface.vertices.size(); ++i)
    surface.vertex_tags.push_back(static_cast<std::int64_t>(i + 1));
  for (std::size_t i = 0; i < surface.triangles.size(); ++i)
    surface.triangle_tags.push_back(static_cast<std::int64_t>(i + 1));
}

/// An octahedron whose triangles are divided by four again and again, on a sphere.
inline mesh::TriangleSurface sphere(double radius, int divisions, const Eigen::Vector3d& centre = {0, 0, 0}) {
  mesh::TriangleSurface s;
  s.vertices = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  s.triangles = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  for (int i = 0; i < divisions; ++i) {
    std::map<std::pair<std::int32_t, std::int32_t>, std::int32_t> middles;
    const auto middle = [&](std::int32_t a, std::int32_t b) {
      const auto [at, is_new] =
          middles.emplace(std::minmax(a, b), static_cast<std::int32_t>(s.vertices.size()));
      if (is_new)
        s.vertices.push_back(
            (s.vertices[static_cast<std::size_t>(a)] + s.vertices[static_cast<std::size_t>(b)]).normalized());
      return at->second;
    };
    std::vector<std::array<std::int32_t, 3>> finer;
    for (const auto& t : s.triangles) {
      const auto a = middle(t[0], t[1]), b = middle(t[1], t[2]), c = middle(t[2], t[0]);
      finer.insert(finer.end(), {{t[0], a, c}, {a, t[1], b}, {c, b, t[2]}, {a, b, c}});
    }
    s.triangles = finer;
  }
  for (auto& x : s.vertices) x = radius * x + centre;
  numberFromOne(s);
  return s;
}

/// The vertex that lies farthest in a direction.
inline std::int32_t farthest(const mesh::TriangleSurface& s, const Eigen::Vector3d& direction) {
  const auto at = std::max_element(s.vertices.begin(), s.vertices.end(), [&](const auto& a, const auto& b) {
    return a.dot(direction) < b.dot(direction);
  });
  return static_cast<std::int32_t>(at - s.vertices.begin());
}

inline Eigen::Vector3d centreOf(const mesh::TriangleSurface& s, const std::array<std::int32_t, 3>& t) {
  const auto at = [&](std::size_t k) { return s.vertices[static_cast<std::size_t>(t[k])]; };
  return (at(0) + at(1) + at(2)) / 3;
}

/// Takes away the triangles within a distance of the surface's farthest vertex in a direction.
inline void cutHole(mesh::TriangleSurface& s, const Eigen::Vector3d& direction, double radius) {
  const Eigen::Vector3d x = s.vertices[static_cast<std::size_t>(farthest(s, direction))];
  std::erase_if(s.triangles, [&](const auto& t) { return (centreOf(s, t) - x).norm() < radius; });
}

/// Turns over the triangles that lie beyond a plane through the centre's neighbourhood.
inline void turnOverBeyond(mesh::TriangleSurface& s, const Eigen::Vector3d& direction, double distance) {
  for (auto& t : s.triangles)
    if (centreOf(s, t).dot(direction) > distance) std::swap(t[0], t[1]);
}

/// Pushes a vertex into the surface below its neighbours and to the side, so that its triangles cross those around.
inline void pushAside(mesh::TriangleSurface& s, const Eigen::Vector3d& direction, double by) {
  const auto v = static_cast<std::size_t>(farthest(s, direction));
  const Eigen::Vector3d x = s.vertices[v];
  s.vertices[v] = x - 0.3 * by * x.normalized() + by * x.unitOrthogonal();
}

/// A loose triangle that pierces the surface.
inline void pierce(mesh::TriangleSurface& s, const Eigen::Vector3d& direction, double size) {
  const Eigen::Vector3d x = s.vertices[static_cast<std::size_t>(farthest(s, direction))] * 0.999;
  const Eigen::Vector3d n = x.normalized(), e = n.unitOrthogonal();
  const auto first = static_cast<std::int32_t>(s.vertices.size());
  s.vertices.insert(s.vertices.end(), {x + size * n, x - size * n + size * e, x - size * n - 0.7 * size * e});
  s.triangles.push_back({first, first + 1, first + 2});
}

/// What scanners leave: ten vertices pushed aside and ten loose triangles (crossings), two holes, two parts turned
/// over, three triangles twice, and one without area.
inline mesh::TriangleSurface spoiledSphere(double radius, int divisions) {
  mesh::TriangleSurface s = sphere(radius, divisions);
  const double edge = 1.6 * radius / (1 << divisions);
  turnOverBeyond(s, {0, 0, 1}, 0.8 * radius);
  turnOverBeyond(s, {-0.6, 0.8, 0}, 0.7 * radius);
  cutHole(s, {0.2, 0.1, 1}, 2 * edge);
  cutHole(s, {-0.2, -0.3, -1}, 3 * edge);
  for (int i = 0; i < 10; ++i) {
    const double turn = 2 * std::numbers::pi * i / 10;
    pushAside(s, {std::cos(turn), std::sin(turn), -0.4}, 2.5 * edge);
    pierce(s, {std::cos(turn + 0.3), std::sin(turn + 0.3), 0.4}, 2 * edge);
  }
  for (std::size_t i = 100; i < 103; ++i) s.triangles.push_back(s.triangles[i]);
  s.triangles.push_back({s.triangles[7][0], s.triangles[7][1], s.triangles[7][1]});
  numberFromOne(s);
  return s;
}

/// Text STL: three corners a facet, in `unit` metres.
inline void writeStl(const std::string& path, const mesh::TriangleSurface& s, double unit = 1) {
  std::ofstream out(path);
  out.precision(9);
  out << "solid scan\n";
  for (const auto& t : s.triangles) {
    out << "facet normal 0 0 0\nouter loop\n";
    for (const auto v : t)
      out << "vertex " << s.vertices[static_cast<std::size_t>(v)].transpose() / unit << '\n';
    out << "endloop\nendfacet\n";
  }
  out << "endsolid scan\n";
}

}  // namespace palpate::organ::test
