// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "tools/solver/fem/patch.h"

namespace palpate::solver {

/// Share of the near field at distance r from s: 1 up to 0.7 rho, then smoothly (two derivatives) to 0 at
/// rho. docs/design.md, Parts
[[nodiscard]] double nearWindow(double r, double rho) noexcept;

/// The surface nodes in the near field of one contact position.
struct NearNodes {
  std::vector<std::int32_t> nodes;  ///< surface nodes with |X_i - X_s| < rho, ascending
  std::vector<float> window;        ///< nearWindow of each
};

[[nodiscard]] NearNodes nearNodes(const PatchSurface& surface, const Vec3& x, double rho);

/// How the weight of a node in the fit differs from its area, for one contact position.
struct FitWeights {
  std::vector<std::int32_t> nodes;  ///< surface nodes whose weight is not 1, ascending
  std::vector<float> change;        ///< weight - 1 of each: (1 - nearWindow(r))^2 g(r) - 1
  std::vector<float> shown;         ///< share of the modes' error that is seen there: 1 - nearWindow(r)
};

/// g(r) = max(1, 3 rho / r)^2.5: a ring of large errors round the near field has little area, so least
/// squares over the area alone would keep it. A user sees the largest error.
[[nodiscard]] FitWeights fitWeights(const PatchSurface& surface, const Vec3& x, double rho);

}  // namespace palpate::solver
