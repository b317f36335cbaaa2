// SPDX-License-Identifier: Apache-2.0
#include "core/surface/surface_distance.h"

#include <algorithm>
#include <cmath>

#include "core/base/index.h"
#include "core/surface/face_points.h"

namespace palpate {

namespace {

SurfaceGraph::Corner cornerOf(const Vec3& C, const Vec3& A, const Vec3& B) {
  const double base = (B - A).norm();
  const double x = (C - A).dot(B - A) / base;
  return {(C - A).norm(), (C - B).norm(), base, x, std::sqrt(std::max(0.0, (C - A).squaredNorm() - x * x))};
}

/// Distance at C from a virtual source that lies at distances da, db from A, B in the plane of the triangle.
double unfold(const SurfaceGraph::Corner& C, double da, double db) {
  const double along_edges = std::min(da + C.to_a, db + C.to_b);
  const double c = C.base;
  const double sx = (da * da - db * db + c * c) / (2.0 * c);
  const double height2 = da * da - sx * sx;
  if (height2 < -1e-9 * c * c) return along_edges;  // no such source: the distances come round different ways
  const double sy = std::sqrt(std::max(0.0, height2));  // below AB, C above it
  const double crossing = C.height + sy > 0.0 ? sx + (C.x - sx) * sy / (C.height + sy) : C.x;
  if (crossing < -1e-9 * c || crossing > c * (1.0 + 1e-9)) return along_edges;
  return std::sqrt((C.x - sx) * (C.x - sx) + (C.height + sy) * (C.height + sy));
}

}  // namespace

SurfaceGraph::SurfaceGraph(std::span<const double> positions, std::span<const std::int32_t> triangles,
                           std::span<const std::int32_t> faces)
    : triangles_(triangles.begin(), triangles.end()),
      faces_(faces.empty() ? triangles_ : std::vector(faces.begin(), faces.end())),
      first_(positions.size() / 3 + 1) {
  for (std::size_t i = 0; i + 2 < positions.size(); i += 3)
    positions_.emplace_back(positions[i], positions[i + 1], positions[i + 2]);
  for (const std::int32_t node : triangles_) ++first_[index(node) + 1];
  for (std::size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
  around_.resize(triangles_.size());
  for (std::int32_t t = 0; t < this->triangles(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::span<const std::int32_t> node = triangle(t);
      corners_.push_back(
          cornerOf(position(node[k]), position(node[(k + 1) % 3]), position(node[(k + 2) % 3])));
    }
  std::vector<std::int32_t> next(first_.begin(), first_.end() - 1);
  for (std::size_t corner = 0; corner < triangles_.size(); ++corner)
    around_[index(next[index(triangles_[corner])]++)] = static_cast<std::int32_t>(corner / 3);
}

std::span<const std::int32_t> SurfaceGraph::trianglesOf(std::int32_t node) const noexcept {
  const std::int32_t first = first_[index(node)];
  return std::span(around_).subspan(index(first), index(first_[index(node) + 1] - first));
}

ContactPoint SurfaceGraph::atNode(std::int32_t node) const noexcept {
  ContactPoint s{trianglesOf(node).front(), {}};
  for (std::size_t k = 0; k < 3; ++k) s.barycentric[k] = triangle(s.triangle)[k] == node ? 1.0 : 0.0;
  return faces_.size() == triangles_.size() ? s : faceOf(s);
}

std::vector<double> SurfaceGraph::loadAreas() const {
  if (faces_.size() == triangles_.size()) return lumpedAreas();
  std::vector<double> areas(positions_.size());
  for (std::int32_t f = 0; f < faces(); ++f) {
    const std::span<const std::int32_t> corner = face(f);
    const Vec3& A = position(corner[0]);
    const double area = 0.5 * (position(corner[1]) - A).cross(position(corner[2]) - A).norm();
    for (const std::int32_t middle : triangle(4 * f + 3)) areas[index(middle)] += area / 3.0;
  }
  return areas;
}

std::vector<double> SurfaceGraph::lumpedAreas() const {
  std::vector<double> areas(positions_.size());
  for (std::int32_t t = 0; t < triangles(); ++t) {
    const std::span<const std::int32_t> node = triangle(t);
    const Vec3& A = position(node[0]);
    const double area = 0.5 * (position(node[1]) - A).cross(position(node[2]) - A).norm();
    for (const std::int32_t corner : node) areas[index(corner)] += area / 3.0;
  }
  return areas;
}

SurfaceFront::SurfaceFront(const SurfaceGraph& graph)
    : graph_(graph),
      distance_(index(graph.nodes())),
      state_(index(graph.nodes()), State::kUnseen),
      place_(index(graph.nodes())) {}

const std::vector<SurfaceFront::NodeDistance>& SurfaceFront::from(const ContactPoint& s, double bound) {
  forget();
  bound_ = bound;
  const std::span<const std::int32_t> corner = graph_.triangle(s.triangle);
  Vec3 x = Vec3::Zero();
  for (std::size_t k = 0; k < 3; ++k) x += s.barycentric[k] * graph_.position(corner[k]);
  for (const std::int32_t node : corner) offer(node, (graph_.position(node) - x).norm());
  while (!queue_.empty()) {
    const auto [distance, node] = takeNearest();
    state_[index(node)] = State::kSettled;
    settled_.emplace_back(node, distance);
    for (const std::int32_t t : graph_.trianglesOf(node)) spread(t, node);
  }
  return settled_;
}

void SurfaceFront::offer(std::int32_t node, double distance) {
  if (!(distance < bound_)) return;
  State& state = state_[index(node)];
  if (state == State::kOffered && distance_[index(node)] <= distance) return;
  if (state == State::kUnseen) {
    seen_.push_back(node);
    place_[index(node)] = queue_.size();
    queue_.emplace_back();
  }
  state = State::kOffered;
  distance_[index(node)] = distance;
  rise(place_[index(node)], {distance, node});
}

/// Puts an entry into a place, or above it.
void SurfaceFront::rise(std::size_t place, const Entry& entry) {
  while (place > 0) {
    const std::size_t above = (place - 1) / 2;
    if (queue_[above] <= entry) break;
    queue_[place] = queue_[above];
    place_[index(queue_[place].second)] = place;
    place = above;
  }
  queue_[place] = entry;
  place_[index(entry.second)] = place;
}

/// The gap at the top moves down along the nearer children; the last entry fills it and rises.
SurfaceFront::Entry SurfaceFront::takeNearest() {
  const Entry nearest = queue_.front(), last = queue_.back();
  queue_.pop_back();
  std::size_t place = 0;
  for (std::size_t below = 1; below < queue_.size(); below = 2 * place + 1) {
    if (below + 1 < queue_.size() && queue_[below + 1] < queue_[below]) ++below;
    queue_[place] = queue_[below];
    place_[index(queue_[place].second)] = place;
    place = below;
  }
  if (!queue_.empty()) rise(place, last);
  return nearest;
}

void SurfaceFront::spread(std::int32_t triangle, std::int32_t node) {
  const std::span<const std::int32_t> nodes = graph_.triangle(triangle);
  const std::size_t k = nodes[0] == node ? 0 : nodes[1] == node ? 1 : 2;
  const std::size_t one = (k + 1) % 3, other = (k + 2) % 3;
  const std::int32_t a = nodes[one], b = nodes[other];
  const double distance = distance_[index(node)];
  // What is settled is not offered again.
  const bool has_a = state_[index(a)] == State::kSettled, has_b = state_[index(b)] == State::kSettled;
  if (has_a && has_b) return;
  if (has_a) {
    offer(b, unfold(graph_.corner(triangle, other), distance, distance_[index(a)]));
  } else if (has_b) {
    offer(a, unfold(graph_.corner(triangle, one), distance_[index(b)], distance));
  } else {
    const SurfaceGraph::Corner& corner = graph_.corner(triangle, k);
    offer(a, distance + corner.to_a);
    offer(b, distance + corner.to_b);
  }
}

void SurfaceFront::forget() {
  for (const std::int32_t node : seen_) state_[index(node)] = State::kUnseen;
  seen_.clear();
  settled_.clear();
  queue_.clear();
}

}  // namespace palpate
