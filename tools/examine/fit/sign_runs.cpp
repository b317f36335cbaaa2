// SPDX-License-Identifier: Apache-2.0
#include "tools/examine/fit/sign_runs.h"

#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <cmath>

namespace palpate::fit {

std::optional<double> probabilityOfRuns(std::span<const double> residuals) {
  constexpr double kLeast = 10.0;
  double above = 0.0, below = 0.0, runs = 0.0, before = 0.0;
  for (const double r : residuals) {
    if (r == 0.0) continue;
    (r > 0.0 ? above : below) += 1.0;
    if (before == 0.0 || (before > 0.0) != (r > 0.0)) runs += 1.0;
    before = r;
  }
  if (std::min(above, below) < kLeast) return {};
  const double n = above + below, both = 2.0 * above * below;
  const double mean = 1.0 + both / n, deviation = std::sqrt(both * (both - n) / (n * n * (n - 1.0)));
  return cdf(boost::math::normal(), (runs + 0.5 - mean) / deviation);  // 0.5: runs are whole numbers
}

}  // namespace palpate::fit
