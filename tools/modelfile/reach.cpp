// SPDX-License-Identifier: Apache-2.0
#include "tools/modelfile/reach.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include "core/base/types.h"
#include "tools/modelfile/quantile.h"

namespace palpate::modelfile {

double reachingShare(const Positions& positions, std::span<const double> radius, double travel) {
  const auto at = [](std::int32_t i) { return static_cast<std::size_t>(i); };
  double all = 0.0, reaching = 0.0;
  for (std::size_t t = 0; t < positions.contact_triangles.size(); t += 3) {
    const auto node = positions.contact_triangles.subspan(t, 3);
    std::array<Vec3, 3> X;
    for (std::size_t k = 0; k < 3; ++k)
      X[k] = Eigen::Map<const Vec3>(positions.surface_positions.data() + 3 * at(node[k]));
    const double area = (X[1] - X[0]).cross(X[2] - X[0]).norm();
    for (const std::int32_t i : node) {
      const std::int32_t position = positions.position_of_node[at(i)];
      if (position < 0 || positions.accessible[at(position)] == 0) continue;
      all += area;
      if (radius[at(position)] >= travel) reaching += area;
    }
  }
  return all > 0.0 ? reaching / all : 0.0;
}

std::array<Reach, 3> reachOf(const Positions& positions, std::span<const double> domain,
                             std::span<const double> series) {
  const auto at = [&](double travel) {
    return Reach{travel, reachingShare(positions, domain, travel), reachingShare(positions, series, travel)};
  };
  return {at(0.007), at(0.010), at(0.015)};
}

program::Json reachJson(const Positions& positions, std::span<const double> domain,
                        std::span<const double> series) {
  program::Json list = program::Json::array();
  for (const Reach& r : reachOf(positions, domain, series))
    list.push_back({{"travel", r.travel}, {"by_domain_radius", r.domain}, {"by_series_radius", r.series}});
  return list;
}

program::Json radiusJson(std::span<const std::uint8_t> accessible, std::span<const double> radius) {
  std::vector<double> values;
  for (std::size_t m = 0; m < radius.size(); ++m)
    if (accessible[m] != 0) values.push_back(radius[m]);
  if (values.empty()) return nullptr;
  std::sort(values.begin(), values.end());
  return {{"min", values.front()},
          {"p05", quantile(values, 0.05)},
          {"median", quantile(values, 0.5)},
          {"max", values.back()}};
}

}  // namespace palpate::modelfile
