// SPDX-License-Identifier: Apache-2.0
#include "core/data/load_driven_checks.h"

#include <algorithm>
#include <string>
#include <vector>

#include "core/base/types.h"
#include "core/data/datasets.h"
#include "core/data/parameter_functions.h"

namespace palpate {

namespace {

void checkLevels(const ModelView& v, const Checker& check) {
  constexpr std::size_t kMostNumbers = 500'000'000;  // that checkRising() adds up
  const std::size_t C = v.level_functions, points = v.levels_Z.size() / C;
  check.require(v.levels_Z.size() <= kMostNumbers / v.positions(),
                dataset::kLevelsZ.name() + " has " + std::to_string(v.levels_Z.size()) +
                    " numbers for each of " + std::to_string(v.positions()) + " positions",
                "at most " + std::to_string(kMostNumbers) + " together");
  check.finite(dataset::kLevelsZ.name(), v.levels_Z);
  for (std::size_t q = 0; q < C; ++q)
    if (v.levels_Z[q * points] != 0.0)
      check.failAt(dataset::kLevelsZ.name(), q * points, "is " + digitsOf(v.levels_Z[q * points]),
                   "0 at level 0");
}

/// Displacement along the load, e . d(s, t), must rise up to t_max: a level is found by it.   docs/design.md, Reproduction
void checkRising(const ModelAttributes& a, const ModelView& v, const Checker& check) {
  const auto e = Eigen::Map<const Vec3>(a.load_direction.data());
  const std::size_t C = v.level_functions, points = v.levels_Z.size() / C;
  const int steps = static_cast<int>(points) - 1;
  std::vector<double> along(points);
  for (std::size_t m = 0; m < v.positions(); ++m) {
    const auto last = static_cast<std::size_t>(lastStep(v.contact_domain_radius[m], steps));
    std::fill(along.begin(), along.end(), 0.0);
    for (std::size_t q = 0; q < C; ++q) {
      const double d = e.dot(Eigen::Map<const Vec3>(v.contact_displacement.data() + 3 * (m * C + q)));
      for (std::size_t j = 0; j <= last; ++j) along[j] += d * v.levels_Z[q * points + j];
    }
    for (std::size_t j = 0; j < last; ++j)
      if (!(along[j + 1] > along[j]))
        check.failAt(dataset::kContactDisplacement.name(), m,
                     "along the load goes from " + digitsOf(along[j]) + " m to " + digitsOf(along[j + 1]) +
                         " m between the levels " + digitsOf(double(j) / steps) + " and " +
                         digitsOf(double(j + 1) / steps),
                     "to rise up to t_max = " + digitsOf(v.contact_domain_radius[m]));
  }
}

/// A load-driven model has modes only.                                           docs/design.md, Reproduction
void checkNoNear(const ModelAttributes& a, const ModelView& v, const Checker& check) {
  const std::string should =
      "none: a model with parameters \"" + std::string(toString(a.parameters)) + "\" has no near field";
  check.require(a.near_radius == 0.0, "attribute near_radius is " + digitsOf(a.near_radius), should);
  check.require(v.near_node.empty(),
                dataset::kNearNode.name() + " has " + std::to_string(v.near_node.size()) + " numbers",
                should);
}

}  // namespace

void checkLoadDriven(const ModelAttributes& a, const ModelView& v, const Checker& check) {
  if (a.parameters != Parameters::kDisplacement) checkNoNear(a, v, check);
  if (a.parameters != Parameters::kLevel) return;
  checkLevels(v, check);
  checkRising(a, v, check);
}

}  // namespace palpate
