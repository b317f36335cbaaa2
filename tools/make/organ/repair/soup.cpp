// SPDX-License-Identifier: Apache-2.0
#include "tools/make/organ/repair/soup.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

#include "tools/mesh/mesh_error.h"

namespace palpate::organ {
namespace {

using Eigen::Vector3d;
using Cell = std::array<std::int64_t, 3>;

// Vertices in cells as large as the distance within which they become one: neighbours lie in the next cells.
class Merger {
 public:
  explicit Merger(double distance) : distance_(distance) {}

  /// @return the vertex at x, which is new or an old one nearby
  std::int32_t vertexAt(const Vector3d& x, std::vector<Vector3d>& vertices) {
    const Cell c = cellOf(x);
    for (std::int64_t i = c[0] - 1; i <= c[0] + 1; ++i)
      for (std::int64_t j = c[1] - 1; j <= c[1] + 1; ++j)
        for (std::int64_t k = c[2] - 1; k <= c[2] + 1; ++k) {
          const auto [from, to] = cells_.equal_range({i, j, k});
          for (auto v = from; v != to; ++v)
            if ((vertices[static_cast<std::size_t>(v->second)] - x).norm() <= distance_) return v->second;
        }
    cells_.emplace(c, static_cast<std::int32_t>(vertices.size()));
    vertices.push_back(x);
    return static_cast<std::int32_t>(vertices.size()) - 1;
  }

 private:
  Cell cellOf(const Vector3d& x) const {
    Cell cell{};
    for (std::size_t k = 0; k < 3; ++k)
      cell[k] = static_cast<std::int64_t>(std::floor(x[static_cast<Eigen::Index>(k)] / distance_));
    return cell;
  }

  double distance_;
  std::multimap<Cell, std::int32_t> cells_;
};

double diagonalOf(const mesh::TriangleSurface& surface) {
  Eigen::AlignedBox3d box;
  for (const auto& x : surface.vertices)
    if (x.allFinite()) box.extend(x);
  return box.isEmpty() ? 0 : box.diagonal().norm();
}

}  // namespace

mesh::TriangleSurface cleaned(const mesh::TriangleSurface& surface, Repairs& repairs) {
  const double diagonal = diagonalOf(surface);
  if (!(diagonal > 0)) throw mesh::MeshError("all vertices lie at one place, or nowhere");
  Merger merger(kMergeDistance * diagonal);
  mesh::TriangleSurface clean;
  std::vector<std::int32_t> index(surface.vertices.size(), -1);
  std::set<std::array<std::int32_t, 3>> there;
  std::size_t used = 0;
  for (const auto& t : surface.triangles) {
    const auto at = [&](std::int32_t v) { return surface.vertices[static_cast<std::size_t>(v)]; };
    if (!(at(t[0]).allFinite() && at(t[1]).allFinite() && at(t[2]).allFinite())) {
      ++repairs.not_finite;
      continue;
    }
    std::array<std::int32_t, 3> corners{};
    for (std::size_t k = 0; k < 3; ++k) {
      std::int32_t& own = index[static_cast<std::size_t>(t[k])];
      if (own < 0) ++used, own = merger.vertexAt(at(t[k]), clean.vertices);
      corners[k] = own;
    }
    std::array<std::int32_t, 3> key = corners;
    std::sort(key.begin(), key.end());
    if (key[0] == key[1] || key[1] == key[2]) {
      ++repairs.flat;
    } else if (!there.insert(key).second) {
      ++repairs.twins;
    } else {
      clean.triangles.push_back(corners);
    }
  }
  repairs.merged = used - clean.vertices.size();
  if (clean.triangles.empty()) throw mesh::MeshError("no triangle has an area");
  return clean;
}

}  // namespace palpate::organ
