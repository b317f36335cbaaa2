// SPDX-License-Identifier: Apache-2.0
#include "palpate/core/surface_distance.h"

#include <algorithm>
#include <cmath>

namespace palpate {

namespace {

std::size_t at(std::int32_t i) noexcept {
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

}  // namespace

SurfaceGraph::SurfaceGraph(std::span<const double> positions, std::span<const std::int32_t> triangles)
    : triangles_(triangles.begin(), triangles.end()), first_(positions.size() / 3 + 1) {
  for (std::size_t i = 0; i + 2 < positions.size(); i += 3)
    positions_.emplace_back(positions[i], positions[i + 1], positions[i + 2]);
  for (const std::int32_t node : triangles_) ++first_[at(node) + 1];
  for (std::size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
  around_.resize(triangles_.size());
  std::vector<std::int32_t> next(first_.begin(), first_.end() - 1);
  for (std::size_t corner = 0; corner < triangles_.size(); ++corner)
    around_[at(next[at(triangles_[corner])]++)] = static_cast<std::int32_t>(corner / 3);
}

std::span<const std::int32_t> SurfaceGraph::trianglesOf(std::int32_t node) const noexcept {
  const std::int32_t first = first_[at(node)];
  return std::span(around_).subspan(at(first), at(first_[at(node) + 1] - first));
}

std::vector<double> SurfaceGraph::lumpedAreas() const {
  std::vector<double> areas(positions_.size());
  for (std::int32_t t = 0; t < triangles(); ++t) {
    const std::span<const std::int32_t> node = triangle(t);
    const Vec3& A = position(node[0]);
    const double area = 0.5 * (position(node[1]) - A).cross(position(node[2]) - A).norm();
    for (const std::int32_t corner : node) areas[at(corner)] += area / 3.0;
  }
  return areas;
}

SurfaceFront::SurfaceFront(const SurfaceGraph& graph)
    : graph_(graph), distance_(at(graph.nodes())), state_(at(graph.nodes()), State::kUnseen) {}

const std::vector<SurfaceFront::NodeDistance>& SurfaceFront::from(const ContactPoint& s, double bound) {
  forget();
  bound_ = bound;
  const std::span<const std::int32_t> corner = graph_.triangle(s.triangle);
  Vec3 x = Vec3::Zero();
  for (std::size_t k = 0; k < 3; ++k) x += s.barycentric[k] * graph_.position(corner[k]);
  for (const std::int32_t node : corner) offer(node, (graph_.position(node) - x).norm());
  while (!queue_.empty()) {
    const auto [distance, node] = queue_.top();
    queue_.pop();
    if (state_[at(node)] == State::kSettled) continue;
    state_[at(node)] = State::kSettled;
    settled_.emplace_back(node, distance);
    for (const std::int32_t t : graph_.trianglesOf(node)) spread(graph_.triangle(t), node);
  }
  return settled_;
}

void SurfaceFront::offer(std::int32_t node, double distance) {
  if (distance >= bound_) return;
  State& state = state_[at(node)];
  if (state == State::kOffered && distance_[at(node)] <= distance) return;
  if (state == State::kUnseen) seen_.push_back(node);
  state = State::kOffered;
  distance_[at(node)] = distance;
  queue_.emplace(distance, node);
}

void SurfaceFront::spread(std::span<const std::int32_t> triangle, std::int32_t node) {
  const Vec3& X = graph_.position(node);
  for (const std::int32_t next : triangle) {
    if (state_[at(next)] == State::kSettled) continue;
    offer(next, distance_[at(node)] + (graph_.position(next) - X).norm());
    for (const std::int32_t other : triangle) {
      if (other == next || other == node || state_[at(other)] != State::kSettled) continue;
      offer(next, unfold(X, graph_.position(other), graph_.position(next), distance_[at(node)],
                         distance_[at(other)]));
    }
  }
}

void SurfaceFront::forget() {
  for (const std::int32_t node : seen_) state_[at(node)] = State::kUnseen;
  seen_.clear();
  settled_.clear();
}

}  // namespace palpate
