// SPDX-License-Identifier: Apache-2.0
#include "tools/solver/fit/near_field.h"

#include <algorithm>
#include <cmath>

namespace palpate::solver {

double nearWindow(double r, double rho) noexcept {
  constexpr double kFlat = 0.7;  // of rho: the window falls from there to rho, about one element
  const double t = std::clamp((r / rho - kFlat) / (1.0 - kFlat), 0.0, 1.0);
  return std::max(0.0, 1.0 - t * t * t * (10.0 + t * (-15.0 + 6.0 * t)));
}

NearNodes nearNodes(const PatchSurface& surface, const Vec3& x, double rho) {
  NearNodes near;
  for (std::size_t i = 0; i < surface.positions.size(); ++i) {
    const double r = (surface.positions[i] - x).norm();
    if (r >= rho) continue;
    near.nodes.push_back(static_cast<std::int32_t>(i));
    near.window.push_back(static_cast<float>(nearWindow(r, rho)));
  }
  return near;
}

FitWeights fitWeights(const PatchSurface& surface, const Vec3& x, double rho) {
  FitWeights weights;
  for (std::size_t i = 0; i < surface.positions.size(); ++i) {
    const double r = (surface.positions[i] - x).norm();
    if (r >= 3.0 * rho) continue;
    const double far = 1.0 - nearWindow(r, rho);
    const double emphasis = far > 0.0 ? std::pow(3.0 * rho / r, 2.5) : 0.0;
    weights.nodes.push_back(static_cast<std::int32_t>(i));
    weights.change.push_back(static_cast<float>(far * far * emphasis - 1.0));
    weights.shown.push_back(static_cast<float>(far));
  }
  return weights;
}

}  // namespace palpate::solver
