// SPDX-License-Identifier: Apache-2.0
#include "core/surface/contact_surface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/base/prefetch.h"
#include "core/surface/face_points.h"
#include "core/surface/sort_by_node.h"

namespace palpate {

namespace {

std::size_t index(std::int64_t i) noexcept {
  return static_cast<std::size_t>(i);
}

/// A surface that is being divided.
struct Draft {
  std::vector<Vec3> position;  // m
  std::vector<Vec3> normal;
  std::vector<std::array<std::int32_t, 3>> triangle;
};

/// Middle of the cubic over an edge.
Vec3 middle(const Draft& draft, std::int32_t a, std::int32_t b) {
  const Vec3 along = draft.position[index(b)] - draft.position[index(a)];
  const Vec3 &m = draft.normal[index(a)], &n = draft.normal[index(b)];
  const Vec3 bend = n * n.dot(along) - m * m.dot(along);  // (P_a - P_b) along
  return 0.5 * (draft.position[index(a)] + draft.position[index(b)]) + 0.125 * bend;
}

/// Normals of the nodes: of the triangles round them, weighted by their angles there.
void findNormals(Draft& draft) {
  draft.normal.assign(draft.position.size(), Vec3::Zero());
  for (const auto& node : draft.triangle) {
    const std::array<Vec3, 3> X{draft.position[index(node[0])], draft.position[index(node[1])],
                                draft.position[index(node[2])]};
    const Vec3 face = (X[1] - X[0]).cross(X[2] - X[0]).normalized();
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 one = X[(k + 1) % 3] - X[k], other = X[(k + 2) % 3] - X[k];
      draft.normal[index(node[k])] += std::atan2(one.cross(other).norm(), one.dot(other)) * face;
    }
  }
  for (Vec3& n : draft.normal) n.normalize();
}

/// One side of a triangle, named by the nodes of its edge, so that the two sides of an edge meet when sorted.
struct Side {
  std::int64_t edge;  // smaller node, then larger
  std::size_t slot;   // 3 triangle + the node that lies opposite
  friend bool operator<(const Side& a, const Side& b) { return a.edge < b.edge; }
};

/// The new node on each side of each triangle, [T][3]; adds their positions to `fine`.
std::vector<std::int32_t> addMiddles(const Draft& coarse, Draft& fine) {
  constexpr int kHalf = 32;  // bits
  std::vector<Side> sides;
  sides.reserve(3 * coarse.triangle.size());
  for (const auto& node : coarse.triangle)
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [low, high] = std::minmax({node[(k + 1) % 3], node[(k + 2) % 3]});
      sides.push_back({(std::int64_t{low} << kHalf) | high, sides.size()});
    }
  (void)sortByNode(sides, coarse.position.size(), [](const Side& side) { return index(side.edge >> kHalf); });
  std::vector<std::int32_t> middles(sides.size());
  for (std::size_t i = 0; i < sides.size(); ++i) {
    if (i == 0 || sides[i].edge != sides[i - 1].edge) {
      const auto low = static_cast<std::int32_t>(sides[i].edge >> kHalf);
      const auto high = static_cast<std::int32_t>(sides[i].edge & ((std::int64_t{1} << kHalf) - 1));
      fine.position.push_back(middle(coarse, low, high));
    }
    middles[sides[i].slot] = static_cast<std::int32_t>(fine.position.size()) - 1;
  }
  return middles;
}

/// One level: the corners' triangles first, the middle one last.
Draft divided(const Draft& coarse) {
  Draft fine{coarse.position, {}, {}};
  const std::vector<std::int32_t> middles = addMiddles(coarse, fine);
  fine.triangle.reserve(4 * coarse.triangle.size());
  for (std::size_t t = 0; t < coarse.triangle.size(); ++t) {
    const auto& [a, b, c] = coarse.triangle[t];
    const std::int32_t across_a = middles[3 * t], across_b = middles[3 * t + 1],
                       across_c = middles[3 * t + 2];
    fine.triangle.push_back({a, across_c, across_b});
    fine.triangle.push_back({across_c, b, across_a});
    fine.triangle.push_back({across_b, across_a, c});
    fine.triangle.push_back({across_a, across_b, across_c});
  }
  findNormals(fine);
  return fine;
}

/// Whether each triangle has an area.
bool isSound(const Draft& draft) {
  return std::all_of(draft.triangle.begin(), draft.triangle.end(), [&draft](const auto& node) {
    const Vec3& X = draft.position[index(node[0])];
    const double area = (draft.position[index(node[1])] - X).cross(draft.position[index(node[2])] - X).norm();
    return area > 0.0 && std::isfinite(area);
  });
}

Draft draftOf(const ModelView& view, const SurfaceMesh& rest) {
  Draft draft;
  for (int i = 0; i < rest.nodes(); ++i) {
    draft.position.push_back(Eigen::Map<const Vec3>(view.surface_positions.data() + 3 * index(i)));
    draft.normal.push_back(rest.nodeNormal(i));
  }
  for (std::size_t t = 0; t < index(rest.triangles()); ++t)
    draft.triangle.push_back({view.contact_triangles[3 * t], view.contact_triangles[3 * t + 1],
                              view.contact_triangles[3 * t + 2]});
  return draft;
}

}  // namespace

ContactSurface::ContactSurface(const ModelView& view, const SurfaceMesh& rest) {
  constexpr int kMostLevels = 4;
  constexpr std::size_t kMostTriangles = 300'000;
  Draft draft = draftOf(view, rest);
  const auto wanted = [&] { return levels_ == 0 || 4 * draft.triangle.size() <= kMostTriangles; };
  while (levels_ < kMostLevels && wanted()) {
    Draft finer = divided(draft);
    if (!isSound(finer)) break;
    draft = std::move(finer);
    ++levels_;
  }
  positions_.reserve(3 * draft.position.size());
  triangles_.reserve(3 * draft.triangle.size());
  for (const Vec3& X : draft.position) positions_.insert(positions_.end(), {X.x(), X.y(), X.z()});
  for (const auto& node : draft.triangle) triangles_.insert(triangles_.end(), node.begin(), node.end());
  std::vector<std::uint8_t> reachable(draft.triangle.size());
  for (std::size_t t = 0; t < reachable.size(); ++t)
    reachable[t] = rest.reachable(static_cast<std::int32_t>(t >> (2 * levels_))) ? 1 : 0;
  mesh_ =
      std::make_unique<SurfaceMesh>(positions_, triangles_, std::move(draft.normal), std::move(reachable));
  std::vector<Vec3> rest_points = draft.position;
  findRestPoints(rest, rest_points);
  // At the nodes: between them both surfaces are flat over each fine triangle.
  for (std::size_t i = 0; i < rest_points.size(); ++i)
    bulge_ = std::max(bulge_, (draft.position[i] - rest_points[i]).norm());
  findSlopes(rest_points);
}

/// By node, the point of the rest surface that belongs to it; a node of no triangle has its own place.
void ContactSurface::findRestPoints(const SurfaceMesh& rest, std::span<Vec3> points) const {
  std::vector<bool> found(points.size(), false);
  for (std::size_t i = 0; i < triangles_.size(); ++i) {
    const std::size_t node = index(triangles_[i]);
    if (found[node]) continue;
    found[node] = true;
    ContactPoint corner{static_cast<std::int32_t>(i / 3), {}};
    corner.barycentric[i % 3] = 1.0;
    points[node] = rest.position(this->rest(corner));
  }
}

/// Of each triangle, sum_k v_k grad lambda_k; of a node, those round it, weighted by their areas.
void ContactSurface::findSlopes(std::span<const Vec3> rest_points) {
  slopes_.resize(positions_.size() / 3);
  std::vector<float> weight(slopes_.size(), 0.0F);
  for (std::int32_t t = 0; t < mesh_->triangles(); ++t) {
    const std::array<Vec3, 3> X = mesh_->corners(t);
    const Vec3 twice = (X[1] - X[0]).cross(X[2] - X[0]), face = twice.normalized();
    const auto size = static_cast<float>(twice.norm());
    const std::int32_t* const node = triangles_.data() + 3 * index(t);
    Mat3 normal = Mat3::Zero(), to_rest = Mat3::Zero();  // times twice the area
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 gradient = face.cross(X[(k + 2) % 3] - X[(k + 1) % 3]);
      normal += mesh_->nodeNormal(node[k]) * gradient.transpose();
      to_rest += rest_points[index(node[k])] * gradient.transpose();
    }
    for (std::size_t k = 0; k < 3; ++k) {
      slopes_[index(node[k])].normal += normal.cast<float>();
      slopes_[index(node[k])].rest += to_rest.cast<float>();
      weight[index(node[k])] += size;
    }
  }
  for (std::size_t i = 0; i < slopes_.size(); ++i) {
    slopes_[i].normal /= weight[i];
    slopes_[i].rest /= weight[i];
  }
}

ContactPoint ContactSurface::rest(const ContactPoint& fine) const noexcept PALPATE_NONBLOCKING {
  ContactPoint s = fine;
  for (int level = 0; level < levels_ && s.triangle >= 0; ++level) s = faceOf(s);
  return s;
}

TangentFrame ContactSurface::frame(const SurfaceMesh& rest,
                                   const ContactPoint& fine) const noexcept PALPATE_NONBLOCKING {
  TangentFrame frame = mesh_->place(fine);
  Mat3 normal = Mat3::Zero(), to_rest = Mat3::Zero();
  for (std::size_t k = 0; k < 3; ++k) {
    const Slope& slope = slopes_[index(triangles_[3 * index(fine.triangle) + k])];
    normal += fine.barycentric[k] * slope.normal.cast<double>();
    to_rest += fine.barycentric[k] * slope.rest.cast<double>();
  }
  const Mat3 weights = rest.slopes(fine.triangle >> (2 * levels_));
  for (Eigen::Index i = 0; i < 2; ++i) {
    const Vec3 turning = normal * frame.tangent.col(i);
    frame.turning.col(i) = turning - frame.normal * frame.normal.dot(turning);
    frame.rates.col(i) = weights * to_rest * frame.tangent.col(i);
  }
  return frame;
}

void ContactSurface::expect(std::int32_t triangle) const noexcept PALPATE_NONBLOCKING {
  mesh_->expect(triangle);
  for (std::size_t k = 0; k < 3; ++k) prefetch(slopes_[index(triangles_[3 * index(triangle) + k])]);
}

ContactPoint ContactSurface::fine(const ContactPoint& rest) const noexcept PALPATE_NONBLOCKING {
  ContactPoint s = rest;
  for (int level = 0; level < levels_ && s.triangle >= 0; ++level) s = partOf(s);
  return s;
}

}  // namespace palpate
