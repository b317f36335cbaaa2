// SPDX-License-Identifier: Apache-2.0
#include "tools/modelfile/reach.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cstddef>
#include <numeric>
#include <vector>

#include "core/base/types.h"
#include "tools/modelfile/quantile.h"

namespace palpate::modelfile {

namespace {

/// An accessible corner of a triangle.
struct Corner {
  double area;    ///< of the triangle, times a factor that is the same for all
  Vec3 normal;    ///< of the triangle, outward, of any length
  double radius;  ///< m
};

std::vector<Corner> cornersOf(const Positions& positions, std::span<const double> radius) {
  const auto at = [](std::int32_t i) { return static_cast<std::size_t>(i); };
  std::vector<Corner> corners;
  for (std::size_t t = 0; t < positions.contact_triangles.size(); t += 3) {
    const auto node = positions.contact_triangles.subspan(t, 3);
    std::array<Vec3, 3> X;
    for (std::size_t k = 0; k < 3; ++k)
      X[k] = Eigen::Map<const Vec3>(positions.surface_positions.data() + 3 * at(node[k]));
    const Vec3 normal = (X[1] - X[0]).cross(X[2] - X[0]);
    for (const std::int32_t i : node) {
      const std::int32_t position = positions.position_of_node[at(i)];
      if (position < 0 || positions.accessible[at(position)] == 0) continue;
      corners.push_back({normal.norm(), normal, radius[at(position)]});
    }
  }
  return corners;
}

double areaOf(const std::vector<Corner>& corners) {
  return std::accumulate(corners.begin(), corners.end(), 0.0,
                         [](double sum, const Corner& one) { return sum + one.area; });
}

/// Mean of something over the area. @return 0 where there is none
template <typename Of>
double meanOf(const std::vector<Corner>& corners, const Of& of) {
  const double all = areaOf(corners);
  double sum = 0.0;
  for (const Corner& one : corners) sum += one.area * of(one.radius);
  return all > 0.0 ? sum / all : 0.0;
}

double reaching(const std::vector<Corner>& corners, double travel) {
  return meanOf(corners, [&](double radius) { return radius >= travel ? 1.0 : 0.0; });
}

double touches(const std::vector<Corner>& corners, double travel) {
  return meanOf(corners, [&](double radius) { return touchWithin(radius, travel); });
}

/// Half of the area has less.
double medianOf(std::vector<Corner> corners) {
  std::sort(corners.begin(), corners.end(),
            [](const Corner& l, const Corner& r) { return l.radius < r.radius; });
  double left = 0.5 * areaOf(corners);
  for (const Corner& one : corners)
    if ((left -= one.area) <= 0.0) return one.radius;
  return corners.back().radius;
}

}  // namespace

double touchWithin(double radius, double travel) {
  constexpr double kShortest = 0.2;  // of the travel
  return std::clamp((radius / travel - kShortest) / (1.0 - kShortest), 0.0, 1.0);
}

double reachingShare(const Positions& positions, std::span<const double> radius, double travel) {
  return reaching(cornersOf(positions, radius), travel);
}

double touchesWithin(const Positions& positions, std::span<const double> radius, double travel) {
  return touches(cornersOf(positions, radius), travel);
}

program::Json sidesJson(const Positions& positions, std::span<const double> radius, double travel) {
  constexpr std::array kNames{"+x", "-x", "+y", "-y", "+z", "-z"};
  const std::vector<Corner> all = cornersOf(positions, radius);
  std::array<std::vector<Corner>, 6> sides;
  for (const Corner& one : all) {
    Eigen::Index axis = 0;
    one.normal.cwiseAbs().maxCoeff(&axis);
    sides[static_cast<std::size_t>(2 * axis + (one.normal[axis] < 0.0 ? 1 : 0))].push_back(one);
  }
  program::Json list = program::Json::array();
  for (std::size_t side = 0; side < sides.size(); ++side)
    if (const std::vector<Corner>& own = sides[side]; !own.empty())
      list.push_back({{"side", kNames[side]},
                      {"area_share", areaOf(own) / areaOf(all)},
                      {"median", medianOf(own)},
                      {"reaching", reaching(own, travel)},
                      {"touches", touches(own, travel)}});
  return list;
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
