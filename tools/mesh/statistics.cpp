// SPDX-License-Identifier: Apache-2.0
#include "tools/mesh/statistics.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>
#include <utility>
#include <vector>

#include "tools/mesh/topology.h"

namespace palpate::mesh {
namespace {

using Vec3 = Eigen::Vector3d;
using Edge = std::pair<std::int32_t, std::int32_t>;

double twiceArea(const Vec3& a, const Vec3& b, const Vec3& c) {
  return (b - a).cross(c - a).norm();
}

template <std::size_t Corners>
std::vector<Edge> edgesOf(const std::vector<std::array<std::int32_t, Corners>>& elements) {
  std::vector<Edge> edges;
  for (const auto& e : elements) {
    for (std::size_t i = 0; i < Corners; ++i) {
      for (std::size_t j = i + 1; j < Corners; ++j) edges.emplace_back(std::minmax(e[i], e[j]));
    }
  }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  return edges;
}

template <std::size_t Corners>
std::size_t cornersOf(const std::vector<std::array<std::int32_t, Corners>>& elements) {
  std::set<std::int32_t> corners;
  for (const auto& e : elements) corners.insert(e.begin(), e.end());
  return corners.size();
}

double meanEdge(const TetMesh& mesh) {
  const std::vector<Edge> edges = edgesOf(mesh.tetrahedra);
  double sum = 0;
  for (const auto& [a, b] : edges) {
    sum += (mesh.nodes[static_cast<std::size_t>(a)] - mesh.nodes[static_cast<std::size_t>(b)]).norm();
  }
  return sum / static_cast<double>(edges.size());
}

double medianSurfaceEdge(const TetMesh& mesh, const BoundarySurface& boundary) {
  std::vector<double> lengths;
  for (const auto& [a, b] : edgesOf(boundary.faces)) {
    const auto i = static_cast<std::size_t>(boundary.nodes[static_cast<std::size_t>(a)]);
    const auto j = static_cast<std::size_t>(boundary.nodes[static_cast<std::size_t>(b)]);
    lengths.push_back((mesh.nodes[i] - mesh.nodes[j]).norm());
  }
  const auto middle = lengths.begin() + static_cast<std::ptrdiff_t>(lengths.size() / 2);
  std::nth_element(lengths.begin(), middle, lengths.end());
  return *middle;
}

}  // namespace

double quality(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const double volume = std::abs((b - a).dot((c - a).cross(d - a))) / 6;
  const double area = (twiceArea(a, b, c) + twiceArea(a, b, d) + twiceArea(a, c, d) + twiceArea(b, c, d)) / 2;
  // Circumradius R: 24 V R = sqrt(s(s-2x)(s-2y)(s-2z)), x, y, z the products of opposite edges, s their sum.
  const double x = (b - a).norm() * (d - c).norm();
  const double y = (c - a).norm() * (d - b).norm();
  const double z = (d - a).norm() * (c - b).norm();
  const double product = (x + y + z) * (y + z - x) * (x + z - y) * (x + y - z);
  if (!(product > 0) || !(area > 0)) return 0;
  return std::min(1.0, 3 * (3 * volume / area) * (24 * volume / std::sqrt(product)));
}

MeshStatistics statisticsOf(const TetMesh& mesh, const BoundarySurface& boundary) {
  MeshStatistics s;
  s.nodes = mesh.nodes.size();
  s.corners = cornersOf(mesh.tetrahedra);
  s.tetrahedra = mesh.tetrahedra.size();
  s.surface_nodes = boundary.nodes.size();
  s.surface_corners = cornersOf(boundary.faces);
  s.surface_triangles = boundary.faces.size();
  s.box_min = s.box_max = mesh.nodes.front();
  for (const auto& x : mesh.nodes) {
    s.box_min = s.box_min.cwiseMin(x);
    s.box_max = s.box_max.cwiseMax(x);
  }
  s.worst_quality = std::numeric_limits<double>::infinity();
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    s.volume += signedVolume(mesh, t);
    const auto at = [&](std::size_t i) -> const Vec3& {
      return mesh.nodes[static_cast<std::size_t>(mesh.tetrahedra[t][i])];
    };
    const double q = quality(at(0), at(1), at(2), at(3));
    if (q >= s.worst_quality) continue;
    s.worst_quality = q;
    s.worst_tetrahedron = mesh.tetrahedron_tags[t];
  }
  s.mean_edge = meanEdge(mesh);
  s.median_surface_edge = medianSurfaceEdge(mesh, boundary);
  return s;
}

}  // namespace palpate::mesh
