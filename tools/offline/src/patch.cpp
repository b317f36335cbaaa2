// SPDX-License-Identifier: Apache-2.0
#include "palpate/offline/patch.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <queue>
#include <utility>

namespace palpate::offline {

namespace {

std::size_t at(int i) {
  return static_cast<std::size_t>(i);
}

/// Distance at C from a virtual source that lies at distances da, db from A, B in the plane of the triangle.
double unfold(const Vec3& A, const Vec3& B, const Vec3& C, double da, double db) {
  const double along_edges = std::min(da + (C - A).norm(), db + (C - B).norm());
  const double c = (B - A).norm();
  const Vec3 x_axis = (B - A) / c;
  const double cx = (C - A).dot(x_axis);
  const double cy = std::sqrt(std::max(0.0, (C - A).squaredNorm() - cx * cx));
  const double sx = (da * da - db * db + c * c) / (2.0 * c);
  const double height2 = da * da - sx * sx;
  if (height2 < -1e-9 * c * c) return along_edges;  // no such source: the distances come round different ways
  const double sy = std::sqrt(std::max(0.0, height2));  // below AB, C above it
  const double crossing = cy + sy > 0.0 ? sx + (cx - sx) * sy / (cy + sy) : cx;
  if (crossing < -1e-9 * c || crossing > c * (1.0 + 1e-9)) return along_edges;
  return std::hypot(cx - sx, cy + sy);
}

/// The front: a priority queue of nodes by tentative distance.
class Front {
 public:
  Front(const ContactSurface& surface, double bound) : surface_(surface), bound_(bound) {}

  void offer(std::int32_t node, double distance) {
    if (distance >= bound_) return;
    const auto found = distance_.find(node);
    if (found != distance_.end() && found->second <= distance) return;
    distance_[node] = distance;
    queue_.emplace(distance, node);
  }

  std::vector<std::pair<std::int32_t, double>> run() {
    std::vector<std::pair<std::int32_t, double>> settled;
    while (!queue_.empty()) {
      const auto [distance, node] = queue_.top();
      queue_.pop();
      if (distance > distance_[node] || done_.count(node) != 0) continue;
      done_[node] = distance;
      settled.emplace_back(node, distance);
      for (const std::int32_t t : surface_.triangles_of_node[at(node)])
        spread(surface_.triangles[at(t)], node);
    }
    return settled;
  }

 private:
  void spread(const std::array<std::int32_t, 3>& triangle, std::int32_t node) {
    const auto& X = surface_.positions;
    for (const std::int32_t next : triangle) {
      if (done_.count(next) != 0) continue;
      offer(next, done_[node] + (X[at(next)] - X[at(node)]).norm());
      for (const std::int32_t other : triangle) {
        if (other == next || other == node || done_.count(other) == 0) continue;
        offer(next, unfold(X[at(node)], X[at(other)], X[at(next)], done_[node], done_[other]));
      }
    }
  }

  const ContactSurface& surface_;
  double bound_;
  std::map<std::int32_t, double> distance_;
  std::map<std::int32_t, double> done_;
  std::priority_queue<std::pair<double, std::int32_t>, std::vector<std::pair<double, std::int32_t>>,
                      std::greater<>>
      queue_;
};

}  // namespace

ContactSurface::ContactSurface(const FeModel& model, std::vector<std::int32_t> surface_nodes,
                               std::vector<std::array<std::int32_t, 3>> surface_triangles)
    : nodes(std::move(surface_nodes)), triangles(std::move(surface_triangles)) {
  for (const std::int32_t node : nodes) positions.push_back(model.nodes()[at(node)]);
  areas.assign(nodes.size(), 0.0);
  triangles_of_node.resize(nodes.size());
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const auto& [a, b, c] = triangles[t];
    const Vec3& A = positions[at(a)];
    const double area = 0.5 * (positions[at(b)] - A).cross(positions[at(c)] - A).norm();
    for (const std::int32_t node : triangles[t]) {
      areas[at(node)] += area / 3.0;
      triangles_of_node[at(node)].push_back(static_cast<std::int32_t>(t));
    }
  }
}

Vec3 ContactSurface::position(const SurfacePoint& s) const {
  Vec3 x = Vec3::Zero();
  for (std::size_t k = 0; k < 3; ++k) x += s.barycentric[k] * positions[at(triangles[at(s.triangle)][k])];
  return x;
}

SurfacePoint ContactSurface::atNode(int node) const {
  SurfacePoint s;
  s.triangle = triangles_of_node[at(node)].front();
  for (std::size_t k = 0; k < 3; ++k) s.barycentric[k] = triangles[at(s.triangle)][k] == node ? 1.0 : 0.0;
  return s;
}

double ContactSurface::medianEdge() const {
  std::vector<double> lengths;
  for (const auto& t : triangles)
    for (std::size_t k = 0; k < 3; ++k)
      lengths.push_back((positions[at(t[k])] - positions[at(t[(k + 1) % 3])]).norm());
  const auto middle = lengths.begin() + static_cast<std::ptrdiff_t>(lengths.size() / 2);
  std::nth_element(lengths.begin(), middle, lengths.end());
  return *middle;
}

std::vector<std::pair<std::int32_t, double>> surfaceDistances(const ContactSurface& surface,
                                                              const SurfacePoint& s, double bound) {
  Front front(surface, bound);
  const Vec3 x = surface.position(s);
  for (const std::int32_t node : surface.triangles[at(s.triangle)])
    front.offer(node, (surface.positions[at(node)] - x).norm());
  return front.run();
}

Patch makePatch(const FeModel& model, const ContactSurface& surface, const SurfacePoint& s, double a) {
  Patch patch;
  double total = 0.0;
  double free_total = 0.0;
  for (const auto& [node, r] : surfaceDistances(surface, s, 3.0 * a)) {
    const double weight = surface.areas[at(node)] * std::exp(-0.5 * r * r / (a * a));
    total += weight;
    const std::int32_t volume_node = surface.nodes[at(node)];
    if (!model.isFree(volume_node)) continue;
    free_total += weight;
    patch.nodes.push_back(volume_node);
    patch.weights.push_back(weight);
  }
  for (double& weight : patch.weights) weight /= free_total;
  patch.free_share = total > 0.0 ? free_total / total : 0.0;
  return patch;
}

}  // namespace palpate::offline
