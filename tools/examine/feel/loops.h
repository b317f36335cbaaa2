// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "core/model/meta_model.h"

namespace palpate::feel {

struct LoopOptions {
  int loops{1000};
  double tick{1e-3};  ///< s
  unsigned seed{1};
};

/// Work over one closed path of the tool.
struct LoopResult {
  double work{0.0};     ///< done by the hand, J: the integral of -force . dc, trapezoidal over the ticks
  double stored{0.0};   ///< largest stored energy W(s, d) on the path, J
  double highest{0.0};  ///< largest |d|, m
  int releases{0};      ///< releases of the tool at more than 1 mN; these lose energy
  [[nodiscard]] double share() const noexcept { return stored > 0.0 ? work / stored : 0.0; }
};

/// Random closed paths from d = 0 to d = 0 inside the domain, with a fixed anchor (mu infinite).
[[nodiscard]] std::vector<LoopResult> heldLoops(const MetaModel& model, const LoopOptions& options);

/// Press at one place, slide to another 20 to 40 mm away, release there, return through the air. The paths
/// join soft and stiff places, in both directions in turn.
/// @param[in] depth  m, @param[in] friction  mu
[[nodiscard]] std::vector<LoopResult> slidingLoops(const MetaModel& model, const LoopOptions& options,
                                                   double depth, double friction);

}  // namespace palpate::feel
