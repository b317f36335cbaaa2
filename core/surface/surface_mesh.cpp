// SPDX-License-Identifier: Apache-2.0
#include "core/surface/surface_mesh.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "core/base/index.h"
#include "core/base/prefetch.h"
#include "core/data/datasets.h"
#include "core/surface/face_points.h"
#include "core/surface/sort_by_node.h"

namespace palpate {

namespace {

/// A directed edge of a triangle.
struct Edge {
  std::int32_t from, to;
  std::int32_t triangle;
  int opposite;  ///< the triangle's node that is not on it
  friend bool operator<(const Edge& a, const Edge& b) {
    return std::pair(a.from, a.to) < std::pair(b.from, b.to);
  }
};

[[noreturn]] void refuse(std::int32_t triangle, const std::string& what) {
  throw std::invalid_argument(dataset::kContactTriangles.name() + " number " + std::to_string(triangle) +
                              " " + what);
}

std::vector<Edge> edgesOf(std::span<const std::int32_t> triangles) {
  std::vector<Edge> edges;
  edges.reserve(triangles.size());
  for (std::size_t t = 0; t < triangles.size() / 3; ++t)
    for (std::size_t k = 0; k < 3; ++k)
      edges.push_back({triangles[3 * t + (k + 1) % 3], triangles[3 * t + (k + 2) % 3],
                       static_cast<std::int32_t>(t), static_cast<int>(k)});
  return edges;
}

std::string name(const Edge& edge) {
  return std::to_string(edge.from) + " to " + std::to_string(edge.to);
}

}  // namespace

SurfaceMesh::SurfaceMesh(const ModelView& view)
    : positions_(view.surface_positions),
      triangles_(view.contact_triangles),
      drawn_(view.surface_triangles),
      position_of_node_(view.position_of_node),
      position_accessible_(view.contact_accessible),
      triangle_at_node_(view.surface_positions.size() / 3, -1),
      tree_(view.surface_positions, view.contact_triangles) {
  buildFaceNormals();
  buildNodeNormals();
  findNeighbours();
  findReachable();
}

SurfaceMesh::SurfaceMesh(std::span<const double> positions, std::span<const std::int32_t> triangles,
                         int levels, std::vector<Vec3> node_normals,
                         std::vector<std::array<std::int32_t, 3>> neighbours,
                         std::vector<std::uint8_t> reachable)
    : positions_(positions),
      triangles_(triangles),
      neighbours_(std::move(neighbours)),
      node_normals_(std::move(node_normals)),
      reachable_(std::move(reachable)),
      triangle_at_node_(positions.size() / 3, -1),
      tree_(positions, triangles, levels) {
  buildFaceNormals();
}

Vec3 SurfaceMesh::nodePosition(std::int32_t node) const noexcept PALPATE_NONBLOCKING {
  return Eigen::Map<const Vec3>(positions_.data() + 3 * index(node));
}

void SurfaceMesh::buildFaceNormals() {
  face_normals_.reserve(index(triangles()));
  for (std::int32_t t = 0; t < triangles(); ++t) {
    const std::array<Vec3, 3> corner = corners(t);
    const Vec3 area = (corner[1] - corner[0]).cross(corner[2] - corner[0]);
    const double size = area.norm();
    if (!(size > 0.0) || !std::isfinite(size)) refuse(t, "has no area");
    face_normals_.push_back(area / size);
    for (std::size_t k = 0; k < 3; ++k) triangle_at_node_[index(triangles_[3 * index(t) + k])] = t;
  }
}

void SurfaceMesh::buildNodeNormals() {
  node_normals_.assign(positions_.size() / 3, Vec3::Zero());
  for (std::int32_t t = 0; t < triangles(); ++t) {
    const std::array<Vec3, 3> corner = corners(t);
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 one = corner[(k + 1) % 3] - corner[k], other = corner[(k + 2) % 3] - corner[k];
      const double angle = std::atan2(one.cross(other).norm(), one.dot(other));
      node_normals_[index(triangles_[3 * index(t) + k])] += angle * face_normals_[index(t)];
    }
  }
  placeMiddles();
  for (std::size_t i = 0; i < node_normals_.size(); ++i) {
    if (triangle_at_node_[i] < 0)
      throw std::invalid_argument(dataset::kSurfacePositions.name() + " number " + std::to_string(i) +
                                  " belongs to no triangle, expected a closed surface");
    if (!(node_normals_[i].norm() > 0.0)) refuse(triangle_at_node_[i], "has a node without a normal");
    node_normals_[i].normalize();
  }
}

/// Nodes in the middle of a face's edges lie on it; their normals are those of the edges' ends.
void SurfaceMesh::placeMiddles() {
  if (drawn_.size() == triangles_.size()) return;
  for (std::size_t t = 0; t < index(triangles()); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t node = index(drawn_[12 * t + 9 + k]);  // across from corner k
      triangle_at_node_[node] = static_cast<std::int32_t>(t);
      node_normals_[node] = node_normals_[index(triangles_[3 * t + (k + 1) % 3])].normalized() +
                            node_normals_[index(triangles_[3 * t + (k + 2) % 3])].normalized();
    }
}

double SurfaceMesh::distanceToNodes(std::int32_t triangle, const Vec3& x) const noexcept PALPATE_NONBLOCKING {
  const std::array<Vec3, 3> X = corners(triangle);
  double nearest = (X[0] - x).squaredNorm();
  for (std::size_t k = 0; k < 3; ++k)
    nearest =
        std::min({nearest, (X[k] - x).squaredNorm(), (0.5 * (X[k] + X[(k + 1) % 3]) - x).squaredNorm()});
  return std::sqrt(nearest);
}

NodeMix SurfaceMesh::nodesAt(const ContactPoint& s) const noexcept PALPATE_NONBLOCKING {
  const ContactPoint part = drawn_.size() == triangles_.size() ? s : partOf(s);
  const std::int32_t* const node = drawn_.data() + 3 * index(part.triangle);
  return {{node[0], node[1], node[2]}, part.barycentric};
}

bool SurfaceMesh::complete(std::int32_t triangle) const noexcept PALPATE_NONBLOCKING {
  const std::int32_t* const node = triangles_.data() + 3 * index(triangle);
  return std::all_of(node, node + 3, [this](std::int32_t i) { return position_of_node_[index(i)] >= 0; });
}

void SurfaceMesh::findReachable() {
  for (std::int32_t t = 0; t < triangles(); ++t) reachable_.push_back(complete(t) && accessible(t) ? 1 : 0);
}

/// Also the proof that the surface is closed: each directed edge once, and its reverse once.
void SurfaceMesh::findNeighbours() {
  std::vector<Edge> edges = edgesOf(triangles_);
  const std::vector<std::size_t> first =
      sortByNode(edges, positions_.size() / 3, [](const Edge& edge) { return index(edge.from); });
  for (std::size_t i = 1; i < edges.size(); ++i)
    if (!(edges[i - 1] < edges[i]))
      refuse(edges[i].triangle,
             "repeats the edge from node " + name(edges[i]) + ", expected a consistently oriented surface");
  neighbours_.resize(face_normals_.size());
  for (const Edge& edge : edges) {
    const auto begin = edges.begin() + std::ptrdiff_t(first[index(edge.to)]);
    const auto end = edges.begin() + std::ptrdiff_t(first[index(edge.to) + 1]);
    const auto twin = std::lower_bound(begin, end, Edge{edge.to, edge.from, 0, 0});
    if (twin == end || twin->to != edge.from)
      refuse(edge.triangle,
             "has no neighbour across the edge from node " + name(edge) + ", expected a closed surface");
    neighbours_[index(edge.triangle)][static_cast<std::size_t>(edge.opposite)] = twin->triangle;
  }
}

NearestPoint SurfaceMesh::closestPoint(const Vec3& c) const noexcept PALPATE_NONBLOCKING {
  const BoundingVolumes::Hit hit = tree_.closest(c);
  const std::size_t t = index(hit.triangle);
  const auto feature = static_cast<std::size_t>(hit.where.feature);
  const auto edge = static_cast<std::size_t>(TriangleFeature::kEdge0);
  const auto node = static_cast<std::size_t>(TriangleFeature::kNode0);
  const auto ofEdge = [&](std::size_t k) {
    return face_normals_[t] + face_normals_[index(neighbours_[t][k])];
  };
  const Vec3 pseudonormal = feature < edge   ? face_normals_[t]
                            : feature < node ? Vec3(ofEdge(feature - edge))
                                             : node_normals_[index(triangles_[3 * t + feature - node])];
  NearestPoint nearest;
  nearest.s = {hit.triangle, hit.where.barycentric};
  nearest.position = hit.where.point;
  const double distance = std::sqrt(hit.where.squared_distance);
  nearest.signed_distance = (c - hit.where.point).dot(pseudonormal) < 0.0 ? -distance : distance;
  return nearest;
}

Vec3 SurfaceMesh::position(const ContactPoint& s) const noexcept PALPATE_NONBLOCKING {
  Vec3 sum = Vec3::Zero();
  for (std::size_t k = 0; k < 3; ++k)
    sum += s.barycentric[k] * nodePosition(triangles_[3 * index(s.triangle) + k]);
  return sum;
}

Vec3 SurfaceMesh::mixedNormal(const ContactPoint& s) const noexcept PALPATE_NONBLOCKING {
  Vec3 sum = Vec3::Zero();
  for (std::size_t k = 0; k < 3; ++k)
    sum += s.barycentric[k] * node_normals_[index(triangles_[3 * index(s.triangle) + k])];
  return sum;
}

Vec3 SurfaceMesh::normal(const ContactPoint& s) const noexcept PALPATE_NONBLOCKING {
  const Vec3 sum = mixedNormal(s);
  const double length = sum.norm();
  return length > kLeastNormal ? Vec3(sum / length) : face_normals_[index(s.triangle)];
}

ContactPoint SurfaceMesh::atNode(int node) const noexcept PALPATE_NONBLOCKING {
  ContactPoint s{triangle_at_node_[index(node)], {}};
  const std::int32_t* const corner = triangles_.data() + 3 * index(s.triangle);
  if (const auto* const found = std::find(corner, corner + 3, node); found < corner + 3) {
    s.barycentric[index(found - corner)] = 1.0;
    return s;
  }
  const std::int32_t* const middle = drawn_.data() + 12 * index(s.triangle) + 9;
  for (std::size_t k = 0; k < 3; ++k) s.barycentric[k] = middle[k] == node ? 0.0 : 0.5;
  return s;
}

bool SurfaceMesh::accessible(int triangle) const noexcept PALPATE_NONBLOCKING {
  for (std::size_t k = 0; k < 3; ++k) {
    const std::int32_t position = position_of_node_[index(triangles_[3 * index(triangle) + k])];
    if (position >= 0 && position_accessible_[index(position)] != 0) return true;
  }
  return false;
}

PositionMix SurfaceMesh::mix(const ContactPoint& s) const noexcept PALPATE_NONBLOCKING {
  constexpr double kLeastWeight = 1e-9;  // below, the point lies on nodes without an answer
  PositionMix mix;
  double sum = 0.0;
  if (s.triangle < 0 || s.triangle >= triangles()) return mix;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::int32_t position = position_of_node_[index(triangles_[3 * index(s.triangle) + k])];
    if (position < 0) continue;
    mix.position[static_cast<std::size_t>(mix.count)] = position;
    mix.weight[static_cast<std::size_t>(mix.count++)] = s.barycentric[k];
    sum += s.barycentric[k];
  }
  if (!(sum > kLeastWeight)) return {};
  for (double& weight : mix.weight) weight /= sum;
  return mix;
}

void SurfaceMesh::expect(std::int32_t triangle) const noexcept PALPATE_NONBLOCKING {
  prefetch(face_normals_[index(triangle)]);
  prefetch(neighbours_[index(triangle)]);
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t node = index(triangles_[3 * index(triangle) + k]);
    prefetch(positions_.data() + 3 * node, 3 * sizeof(double));
    prefetch(node_normals_[node]);
    if (!position_of_node_.empty()) prefetch(position_of_node_[node]);
  }
}

}  // namespace palpate
