// SPDX-License-Identifier: Apache-2.0
#include "palpate/core/smooth_mixing.h"

#include <algorithm>

namespace palpate {

namespace {

std::size_t index(std::int64_t i) noexcept {
  return static_cast<std::size_t>(i);
}

/// The cubic over one triangle, sum_a A_a c_a + sum_a v_a . G_a, of nodal values c and gradients G:
///   A_a = l_a^3 + 3 l_a^2 (l_b + l_c) + 2 l_0 l_1 l_2,   v_a = sum_c (l_a^2 l_c + l_0 l_1 l_2 / 2) (X_c - X_a)
struct Cubic {
  std::array<double, 3> A{};
  std::array<Vec3, 3> v;
  std::array<Vec3, 3> A_slope;  // dA_a/dl
  std::array<Mat3, 3> v_slope;  // dv_a/dl
};

Cubic cubicAt(const std::array<double, 3>& l, const std::array<Vec3, 3>& X) noexcept {
  const std::array<Vec3, 3> slope{Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ()};  // dl_a/dl
  const double product = l[0] * l[1] * l[2];
  const Vec3 product_slope = l[1] * l[2] * slope[0] + l[2] * l[0] * slope[1] + l[0] * l[1] * slope[2];
  Cubic cubic;
  for (std::size_t a = 0; a < 3; ++a) {
    const double square = l[a] * l[a], rest = 1.0 - l[a];
    cubic.A[a] = square * (l[a] + 3.0 * rest) + 2.0 * product;
    cubic.A_slope[a] = 6.0 * l[a] * rest * slope[a] + 2.0 * product_slope;
    cubic.v[a].setZero();
    cubic.v_slope[a].setZero();
    for (std::size_t turn = 1; turn < 3; ++turn) {
      const std::size_t c = (a + turn) % 3;
      const Vec3 edge = X[c] - X[a];
      cubic.v[a] += (square * l[c] + 0.5 * product) * edge;
      const Vec3 rate = 2.0 * l[a] * l[c] * slope[a] + square * slope[c] + 0.5 * product_slope;
      cubic.v_slope[a] += edge * rate.transpose();
    }
  }
  return cubic;
}

void add(Stencil& stencil, std::int32_t position, double weight, const Vec3& slope) noexcept {
  std::size_t i = 0;
  while (i < stencil.count && stencil.position[i] != position) ++i;
  if (i == stencil.count) {
    if (i == Stencil::kMost) return;  // the constructor saw to it that this does not happen
    stencil.position[i] = position;
    stencil.weight[i] = 0.0;
    stencil.slope[i].setZero();
    ++stencil.count;
  }
  stencil.weight[i] += weight;
  stencil.slope[i] += slope;
}

Stencil linear(const SurfaceMesh& surface, const ContactPoint& s) noexcept {
  const PositionMix mix = surface.mix(s);
  Stencil stencil;
  for (std::size_t b = 0; b < index(mix.count); ++b)
    add(stencil, mix.position[b], mix.weight[b], Vec3::Zero());
  return stencil;
}

}  // namespace

SmoothMixing::SmoothMixing(const ModelView& view, const SurfaceMesh& surface)
    : triangles_(view.surface_triangles), position_of_node_(view.position_of_node) {
  constexpr std::size_t kMostParts = Stencil::kMost / 3;  // of a node; beyond, its gradient is taken as zero
  std::vector<std::vector<Part>> parts(index(surface.nodes()));
  std::vector<double> area(parts.size(), 0.0);
  for (std::size_t t = 0; t < triangles_.size() / 3; ++t) addTriangle(view, t, parts, area);
  first_.push_back(0);
  for (std::size_t node = 0; node < parts.size(); ++node) {
    if (parts[node].size() <= kMostParts)
      for (const Part& part : parts[node]) parts_.push_back({part.position, part.gradient / area[node]});
    first_.push_back(parts_.size());
  }
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

Stencil SmoothMixing::at(const SurfaceMesh& surface,
                         const ContactPoint& s) const noexcept PALPATE_NONBLOCKING {
  if (s.triangle < 0 || s.triangle >= surface.triangles() || !surface.complete(s.triangle))
    return linear(surface, s);
  const Cubic cubic = cubicAt(s.barycentric, surface.corners(s.triangle));
  Stencil stencil;
  for (std::size_t a = 0; a < 3; ++a) {
    const std::size_t node = index(triangles_[3 * index(s.triangle) + a]);
    add(stencil, position_of_node_[node], cubic.A[a], cubic.A_slope[a]);
    for (std::size_t i = first_[node]; i < first_[node + 1]; ++i) {
      const Part& part = parts_[i];
      add(stencil, part.position, cubic.v[a].dot(part.gradient),
          cubic.v_slope[a].transpose() * part.gradient);
    }
  }
  return stencil;
}

}  // namespace palpate
