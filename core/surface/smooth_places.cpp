// SPDX-License-Identifier: Apache-2.0
#include "core/surface/smooth_places.h"

#include <algorithm>
#include <utility>

#include "core/base/index.h"

namespace palpate {

namespace {

using EdgeNodes = std::pair<std::int32_t, std::int32_t>;  // positions, the smaller first

EdgeNodes edgeOf(std::int32_t a, std::int32_t b) {
  return {std::min(a, b), std::max(a, b)};
}

}  // namespace

SmoothPlaces::SmoothPlaces(std::span<const double> positions, std::span<const std::int32_t> triangles,
                           std::span<const std::int32_t> position_of_node) {
  const std::size_t T = triangles.size() / 3;
  const auto positionAt = [&](std::size_t t, std::size_t k) {
    return position_of_node[index(triangles[3 * t + k % 3])];
  };
  const auto complete = [&](std::size_t t) {
    return positionAt(t, 0) >= 0 && positionAt(t, 1) >= 0 && positionAt(t, 2) >= 0;
  };
  std::vector<EdgeNodes> edges;
  for (std::size_t t = 0; t < T; ++t)
    for (std::size_t k = 0; k < 3 && complete(t); ++k)
      edges.push_back(edgeOf(positionAt(t, k + 1), positionAt(t, k + 2)));
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  const auto M =
      static_cast<std::size_t>(1 + *std::max_element(position_of_node.begin(), position_of_node.end()));
  std::vector<std::vector<View>> views(M + edges.size());
  of_triangle_.assign(T, {-1, -1, -1, -1, -1, -1});
  const auto add = [&](std::size_t t, bool whole) {
    std::array<Vec3, 3> X;
    for (std::size_t k = 0; k < 3; ++k)
      X[k] = Eigen::Map<const Vec3>(positions.data() + 3 * index(triangles[3 * t + k]));
    const Vec3 across = (X[1] - X[0]).cross(X[2] - X[0]);
    View view{{static_cast<std::int32_t>(t), {}}, across.norm(), Mat3::Zero()};
    for (std::size_t k = 0; k < 3; ++k)
      view.slopes.row(Eigen::Index(k)) =
          across.cross(X[(k + 2) % 3] - X[(k + 1) % 3]).transpose() / across.squaredNorm();
    for (std::size_t k = 0; k < 3; ++k) {
      const std::int32_t p = positionAt(t, k);
      view.s.barycentric = {};
      view.s.barycentric[k] = 1.0;
      if (p >= 0 && (whole || views[index(p)].empty())) views[index(p)].push_back(view);
      if (!whole) continue;
      const auto edge =
          std::lower_bound(edges.begin(), edges.end(), edgeOf(positionAt(t, k + 1), positionAt(t, k + 2)));
      const std::size_t place = M + static_cast<std::size_t>(edge - edges.begin());
      of_triangle_[t][k] = p;
      of_triangle_[t][3 + k] = static_cast<std::int32_t>(place);
      view.s.barycentric = {0.5, 0.5, 0.5};
      view.s.barycentric[k] = 0.0;
      views[place].push_back(view);
    }
  };
  for (std::size_t t = 0; t < T; ++t)
    if (complete(t)) add(t, true);
  for (std::size_t t = 0; t < T; ++t)
    if (!complete(t)) add(t, false);
  first_.push_back(0);
  for (std::vector<View>& round : views) {
    double area = 0.0;
    for (const View& view : round) area += view.share;
    for (View& view : round) view.share /= area;
    views_.insert(views_.end(), round.begin(), round.end());
    first_.push_back(views_.size());
  }
}

}  // namespace palpate
