// SPDX-License-Identifier: Apache-2.0
#include "outward.h"

#include <limits>

namespace palpate::viewer {
namespace {

client::Point cross(const client::Point& a, const client::Point& b) noexcept {
  return {{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]}};
}

}  // namespace

Outward::Outward(const client::Surface& surface)
    : positions_(surface.positions), normals_(surface.positions.size()) {
  for (const auto& [a, b, c] : surface.triangles) {
    const client::Point area = cross(positions_[b] - positions_[a], positions_[c] - positions_[a]);
    for (const std::uint32_t corner : {a, b, c}) normals_[corner] = normals_[corner] + area;
  }
  for (client::Point& n : normals_)
    if (const double size = length(n); size > 0.0) n = (1.0 / size) * n;
}

client::Point Outward::at(const client::Point& p_W) const noexcept {
  double least = std::numeric_limits<double>::infinity();
  client::Point normal{};
  for (std::size_t i = 0; i < positions_.size(); ++i) {
    const client::Point way = p_W - positions_[i];
    if (const double square = dot(way, way); square < least) {
      least = square;
      normal = normals_[i];
    }
  }
  return dot(normal, normal) > 0.5 ? normal : client::Point{{0.0, 0.0, 1.0}};
}

}  // namespace palpate::viewer
