// SPDX-License-Identifier: Apache-2.0
#include "core/model/smooth_mixing.h"

#include <algorithm>

#include "core/base/index.h"
#include "core/base/prefetch.h"

namespace palpate {

namespace {

/// The cubic over one triangle, sum_a A_a c_a + sum_a sum_c B_ac (X_c - X_a) . G_a, of nodal values c, gradients G:
///   A_a = l_a^3 + 3 l_a^2 (l_b + l_c) + 2 l_0 l_1 l_2,   B_ac = l_a^2 l_c + l_0 l_1 l_2 / 2
/// Each with its derivative by l below it.
struct Cubic {
  std::array<Vec4, 3> A;
  std::array<std::array<Vec4, 2>, 3> B;  // [a][turn]: c = a + 1 + turn, modulo 3
};

Cubic cubicAt(const std::array<double, 3>& l) noexcept PALPATE_NONBLOCKING {
  const std::array<Vec4, 3> slope{Vec4::Unit(1), Vec4::Unit(2), Vec4::Unit(3)};  // dl_a/dl
  const Vec4 product(l[0] * l[1] * l[2], l[1] * l[2], l[2] * l[0], l[0] * l[1]);
  Cubic cubic;
  for (std::size_t a = 0; a < 3; ++a) {
    const double square = l[a] * l[a], rest = 1.0 - l[a];
    cubic.A[a] = square * (l[a] + 3.0 * rest) * Vec4::Unit(0) + 6.0 * l[a] * rest * slope[a] + 2.0 * product;
    for (std::size_t turn = 0; turn < 2; ++turn) {
      const std::size_t c = (a + 1 + turn) % 3;
      cubic.B[a][turn] =
          square * l[c] * Vec4::Unit(0) + 2.0 * l[a] * l[c] * slope[a] + square * slope[c] + 0.5 * product;
    }
  }
  return cubic;
}

}  // namespace

Stencil linearStencil(const PositionMix& mix) noexcept PALPATE_NONBLOCKING {
  Stencil stencil;
  stencil.count = index(mix.count);
  for (std::size_t b = 0; b < stencil.count; ++b) {
    stencil.position[b] = mix.position[b];
    stencil.weight[b] = mix.weight[b];
    stencil.slope[b].setZero();
  }
  return stencil;
}

SmoothMixing::SmoothMixing(const ModelView& view, const SurfaceMesh& surface)
    : triangles_(view.contact_triangles), position_of_node_(view.position_of_node) {
  constexpr std::size_t kMostParts = Stencil::kMost / 3;  // of a node; beyond, its gradient is taken as zero
  std::vector<std::vector<Part>> parts(index(surface.nodes()));
  std::vector<double> area(parts.size(), 0.0);
  for (std::size_t t = 0; t < triangles_.size() / 3; ++t) addTriangle(view, t, parts, area);
  for (std::size_t node = 0; node < parts.size(); ++node) {
    if (parts[node].size() > kMostParts) parts[node].clear();
    for (Part& part : parts[node]) part.gradient /= area[node];
  }
  first_.push_back({0, 0});
  for (std::int32_t t = 0; t < surface.triangles(); ++t) {
    if (surface.complete(t)) addStencil(surface, t, parts);
    first_.push_back({positions_.size(), shares_.size()});
  }
}

/// Which positions answer in a triangle, each once, those of its nodes first; and what they get of its nodes' gradients.
void SmoothMixing::addStencil(const SurfaceMesh& surface, std::int32_t triangle,
                              const std::vector<std::vector<Part>>& parts) {
  const std::span<const std::int32_t> node = triangles_.subspan(3 * index(triangle), 3);
  const std::array<Vec3, 3> X = surface.corners(triangle);
  std::vector<std::int32_t> known;
  for (const std::int32_t corner : node) known.push_back(position_of_node_[index(corner)]);
  for (std::size_t a = 0; a < 3; ++a)
    for (const Part& part : parts[index(node[a])]) {
      auto found = std::find(known.begin(), known.end(), part.position);
      if (found == known.end()) found = known.insert(found, part.position);
      shares_.push_back({part.gradient.dot(X[(a + 1) % 3] - X[a]), part.gradient.dot(X[(a + 2) % 3] - X[a]),
                         static_cast<std::uint8_t>(a), static_cast<std::uint8_t>(found - known.begin())});
    }
  positions_.insert(positions_.end(), known.begin(), known.end());
}

/// The gradients of a triangle's three linear functions, times its area, go to each of its nodes. A triangle with a
/// node that has no contact position has no gradient.
void SmoothMixing::addTriangle(const ModelView& view, std::size_t triangle,
                               std::vector<std::vector<Part>>& parts, std::vector<double>& area) const {
  const std::span<const std::int32_t> node = triangles_.subspan(3 * triangle, 3);
  std::array<Vec3, 3> X;
  for (std::size_t k = 0; k < 3; ++k) {
    if (position_of_node_[index(node[k])] < 0) return;
    X[k] = Eigen::Map<const Vec3>(view.surface_positions.data() + 3 * index(node[k]));
  }
  const Vec3 twice_area = (X[1] - X[0]).cross(X[2] - X[0]);
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3 gradient =
        0.5 * twice_area.normalized().cross(X[(k + 2) % 3] - X[(k + 1) % 3]);  // times the area
    const std::int32_t position = position_of_node_[index(node[k])];
    for (std::size_t at = 0; at < 3; ++at) {
      std::vector<Part>& list = parts[index(node[at])];
      const auto known = std::find_if(list.begin(), list.end(),
                                      [position](const Part& part) { return part.position == position; });
      if (known == list.end())
        list.push_back({position, gradient});
      else
        known->gradient += gradient;
    }
    area[index(node[k])] += 0.5 * twice_area.norm();
  }
}

std::span<const std::int32_t> SmoothMixing::expect(std::int32_t triangle) const noexcept PALPATE_NONBLOCKING {
  const First& first = first_[index(triangle)];
  const First& end = first_[index(triangle) + 1];
  prefetch(shares_.data() + first.share, (end.share - first.share) * sizeof(Share));
  return std::span(positions_).subspan(first.position, end.position - first.position);
}

Stencil SmoothMixing::at(const SurfaceMesh& surface,
                         const ContactPoint& s) const noexcept PALPATE_NONBLOCKING {
  if (s.triangle < 0 || s.triangle >= surface.triangles() || !surface.complete(s.triangle))
    return linearStencil(surface.mix(s));
  Stencil stencil;
  const Cubic cubic = cubicAt(s.barycentric);
  const First& first = first_[index(s.triangle)];
  const First& end = first_[index(s.triangle) + 1];
  std::array<Vec4, Stencil::kMost> sum;  // weight and slope
  std::copy(cubic.A.begin(), cubic.A.end(), sum.begin());
  std::fill(sum.begin() + 3, sum.begin() + std::ptrdiff_t(end.position - first.position), Vec4::Zero());
  for (std::size_t i = first.share; i < end.share; ++i) {
    const Share& share = shares_[i];
    sum[share.of] += share.one * cubic.B[share.corner][0] + share.other * cubic.B[share.corner][1];
  }
  stencil.count = end.position - first.position;
  for (std::size_t b = 0; b < stencil.count; ++b) {
    stencil.position[b] = positions_[first.position + b];
    stencil.weight[b] = sum[b][0];
    stencil.slope[b] = sum[b].tail<3>();
  }
  return stencil;
}

}  // namespace palpate
