// SPDX-License-Identifier: Apache-2.0
#include "core/surface/contact_surface.h"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "core/base/index.h"
#include "core/base/prefetch.h"
#include "core/surface/divided_surface.h"
#include "core/surface/face_points.h"

namespace palpate {

namespace {

DividedSurface undivided(const ModelView& view, const SurfaceMesh& rest) {
  DividedSurface surface;
  for (int i = 0; i < rest.nodes(); ++i) {
    surface.position.push_back(Eigen::Map<const Vec3>(view.surface_positions.data() + 3 * index(i)));
    surface.normal.push_back(rest.nodeNormal(i));
  }
  surface.rest = surface.position;
  for (std::size_t t = 0; t < index(rest.triangles()); ++t)
    surface.triangle.push_back({view.contact_triangles[3 * t], view.contact_triangles[3 * t + 1],
                                view.contact_triangles[3 * t + 2]});
  surface.neighbour.assign(rest.neighbours().begin(), rest.neighbours().end());
  return surface;
}

}  // namespace

ContactSurface::ContactSurface(const ModelView& view, const SurfaceMesh& rest, std::size_t most) {
  constexpr int kMostLevels = 4;
  DividedSurface surface = undivided(view, rest);
  const auto wanted = [&] { return levels_ == 0 || 4 * surface.triangle.size() <= most; };
  while (levels_ < kMostLevels && wanted()) {
    std::optional<DividedSurface> finer = surface.divided();
    if (!finer) break;
    surface = std::move(*finer);
    ++levels_;
  }
  positions_.reserve(3 * surface.position.size());
  triangles_.reserve(3 * surface.triangle.size());
  for (const Vec3& X : surface.position) positions_.insert(positions_.end(), {X.x(), X.y(), X.z()});
  for (const auto& node : surface.triangle) triangles_.insert(triangles_.end(), node.begin(), node.end());
  std::vector<std::uint8_t> reachable(surface.triangle.size());
  for (std::size_t t = 0; t < reachable.size(); ++t)
    reachable[t] = rest.reachable(static_cast<std::int32_t>(t >> (2 * levels_))) ? 1 : 0;
  mesh_ = std::make_unique<SurfaceMesh>(positions_, triangles_, levels_, std::move(surface.normal),
                                        std::move(surface.neighbour), std::move(reachable));
  // At the nodes: between them both surfaces are flat over each fine triangle.
  for (std::size_t i = 0; i < surface.rest.size(); ++i)
    bulge_ = std::max(bulge_, (surface.position[i] - surface.rest[i]).norm());
  findSlopes(surface.rest);
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
