// SPDX-License-Identifier: Apache-2.0
#include "outward.h"

#include <limits>

namespace palpate::viewer {
namespace {

device::Point cross(const device::Point& a, const device::Point& b) noexcept {
  return {{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]}};
}

}  // namespace

Outward::Outward(const client::Surface& surface)
    : positions_(surface.positions), normals_(surface.positions.size()) {
  for (const auto& [a, b, c] : surface.triangles) {
    const device::Point area = cross(positions_[b] - positions_[a], positions_[c] - positions_[a]);
    for (const std::uint32_t corner : {a, b, c}) normals_[corner] = normals_[corner] + area;
  }
  for (device::Point& n : normals_)
    if (const double size = length(n); size > 0.0) n = (1.0 / size) * n;
}

device::Point Outward::at(const device::Point& p_W) const noexcept {
  double least = std::numeric_limits<double>::infinity();
  device::Point normal{};
  for (std::size_t i = 0; i < positions_.size(); ++i) {
    const device::Point way = p_W - positions_[i];
    if (const double square = dot(way, way); square < least) {
      least = square;
      normal = normals_[i];
    }
  }
  return dot(normal, normal) > 0.5 ? normal : device::Point{{0.0, 0.0, 1.0}};
}

}  // namespace palpate::viewer
