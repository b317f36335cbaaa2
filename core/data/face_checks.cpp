// SPDX-License-Identifier: Apache-2.0
#include "core/data/face_checks.h"

#include <algorithm>
#include <array>
#include <string>
#include <utility>
#include <vector>

#include "core/base/types.h"
#include "core/data/datasets.h"

namespace palpate {

namespace {

/// Whether a node is in the middle of two others, but for what rounding of a mesh file may do.
bool isMiddle(const ModelView& v, std::int32_t node, std::int32_t a, std::int32_t b) {
  constexpr double kOff = 1e-6;  // of the edge
  const auto at = [&](std::int32_t i) {
    return Vec3(Eigen::Map<const Vec3>(v.surface_positions.data() + 3 * static_cast<std::size_t>(i)));
  };
  return (at(node) - 0.5 * (at(a) + at(b))).norm() <= kOff * (at(b) - at(a)).norm();
}

/// The triangles between contact positions are those of the surface, or faces of quadratic elements: four of these each.
[[gnu::noinline]] void checkContactTriangles(const ModelView& v, const Checker& check) {
  const std::string name = dataset::kContactTriangles.name(), drawn = dataset::kSurfaceTriangles.name();
  check.indices(name, v.contact_triangles, v.surfaceNodes());
  const bool whole = v.contact_triangles.size() == v.surface_triangles.size();
  check.require(whole || 4 * v.contact_triangles.size() == v.surface_triangles.size(),
                name + " has " + std::to_string(v.contactTriangles()) + " triangles",
                std::to_string(v.triangles()) + ", as " + drawn + ", or a quarter of that");
  const auto expect = [&](std::size_t i, std::int32_t found, std::int32_t expected) {
    if (found != expected)
      check.failAt(whole ? name : drawn, i, "is " + std::to_string(found),
                   std::to_string(expected) + ", as " + (whole ? drawn : name) + " has it");
  };
  for (std::size_t i = 0; whole && i < v.contact_triangles.size(); ++i)
    expect(i, v.contact_triangles[i], v.surface_triangles[i]);
  for (std::size_t t = 0; !whole && t < v.contactTriangles(); ++t) {
    const auto corner = v.contact_triangles.subspan(3 * t, 3), part = v.surface_triangles.subspan(12 * t, 12);
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t next = (k + 1) % 3, last = (k + 2) % 3;
      expect(12 * t + 4 * k, part[4 * k], corner[k]);  // in its own triangle; the next ones are middles
      expect(12 * t + 3 * k + next, part[3 * k + next], part[9 + last]);
      expect(12 * t + 3 * k + last, part[3 * k + last], part[9 + next]);
      if (!isMiddle(v, part[9 + k], corner[next], corner[last]))
        check.failAt(drawn, 12 * t + 9 + k, "is " + std::to_string(part[9 + k]),
                     "the node in the middle of " + std::to_string(corner[next]) + " and " +
                         std::to_string(corner[last]));
    }
  }
}

/// The drawn surface is closed where the faces are: each edge has one middle, which is no corner and of no other edge.
[[gnu::noinline]] void checkMiddles(const ModelView& v, const Checker& check) {
  if (v.contactTriangles() == v.triangles()) return;
  std::vector<std::array<std::int32_t, 2>> edge_of(v.surfaceNodes(),
                                                   {-1, -1});  // of a middle; a corner has itself
  for (const std::int32_t node : v.contact_triangles) edge_of[static_cast<std::size_t>(node)] = {node, node};
  const auto refuse = [&](std::size_t i) {
    check.failAt(dataset::kSurfaceTriangles.name(), i, "is " + std::to_string(v.surface_triangles[i]),
                 "one node in the middle of each edge, and of one edge only");
  };
  using Edge = std::array<std::int32_t, 2>;
  std::vector<std::pair<Edge, std::size_t>> middles;  // each once, and where it is first
  for (std::size_t t = 0; t < v.contactTriangles(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::int32_t a = v.contact_triangles[3 * t + (k + 1) % 3],
                         b = v.contact_triangles[3 * t + (k + 2) % 3];
      const Edge edge{std::min(a, b), std::max(a, b)};
      const std::size_t i = 12 * t + 9 + k;
      Edge& known = edge_of[static_cast<std::size_t>(v.surface_triangles[i])];
      if (known[0] < 0) middles.emplace_back(known = edge, i);
      if (known != edge) refuse(i);
    }
  std::sort(middles.begin(), middles.end());
  for (std::size_t m = 1; m < middles.size(); ++m)
    if (middles[m].first == middles[m - 1].first) refuse(middles[m].second);
}

/// Contact positions are corners of the triangles between them.
[[gnu::noinline]] void checkPositionsAreCorners(const ModelView& v, const Checker& check) {
  std::vector<bool> corner(v.surfaceNodes(), false);
  for (const std::int32_t node : v.contact_triangles) corner[static_cast<std::size_t>(node)] = true;
  for (std::size_t m = 0; m < v.positions(); ++m)
    if (!corner[static_cast<std::size_t>(v.contact_node[m])])
      check.failAt(dataset::kContactNode.name(), m, "is " + std::to_string(v.contact_node[m]),
                   "a node of " + dataset::kContactTriangles.name());
}

}  // namespace

void checkFaces(const ModelView& v, const Checker& check) {
  checkContactTriangles(v, check);
  checkMiddles(v, check);
  checkPositionsAreCorners(v, check);
  check.require(
      v.mesh_midsides.empty() == (v.triangles() == v.contactTriangles()),
      dataset::kContactTriangles.name() + " has " + std::to_string(v.contactTriangles()) + " triangles, " +
          dataset::kMeshMidsides.name() + " is " + (v.mesh_midsides.empty() ? "missing" : "there"),
      "a quarter of " + dataset::kSurfaceTriangles.name() + " with quadratic elements, else all of it");
}

}  // namespace palpate
