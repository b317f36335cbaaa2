// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "../driver.h"
#include "core/response/patch_response.h"

namespace palpate::testing {

inline const SyntheticOptions& options() {
  static const SyntheticOptions instance{
      .subdivisions = 2, .order = 3, .force_order = 5, .series_radius = 0.01};
  return instance;
}

inline const MetaModel& touchedOrgan() {
  static const MetaModel model = loadSynthetic(options());
  return model;
}

class RandomTouch {
 public:
  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine_);
  }
  Vec3 vector(double size) { return {uniform(-size, size), uniform(-size, size), uniform(-size, size)}; }
  /// A point somewhere on the accessible surface.
  ContactPoint contactPoint() {
    for (;;) {
      const auto triangle =
          static_cast<int>(engine_() % static_cast<unsigned>(touchedOrgan().surface().triangles()));
      const double a = uniform(0.0, 1.0), b = uniform(0.0, 1.0 - a);
      if (touchedOrgan().surface().accessible(triangle)) return {triangle, {1.0 - a - b, a, b}};
    }
  }

 private:
  std::mt19937 engine_{11};
};

inline std::vector<float> field(const ContactPoint& s, const Vec3& d) {
  FieldScratch scratch(touchedOrgan());
  std::vector<float> u(touchedOrgan().view().surface_positions.size());
  evaluateField(touchedOrgan(), s, d, scratch, u);
  return u;
}

inline double largestDifference(const std::vector<float>& a, const std::vector<float>& b) {
  double most = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, double(std::abs(a[i] - b[i])));
  return most;
}

}  // namespace palpate::testing
