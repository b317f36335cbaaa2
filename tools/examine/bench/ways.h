// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "core/model/meta_model.h"

namespace palpate::bench {

struct WayOptions {
  double depth;       ///< of the tip below the surface, m; below 0: above it
  double press;       ///< by which the depth varies on the path, twice in and out, m
  double tip_radius;  ///< R, m
  int ways{20};
  double length{0.02};  ///< of the tip's way, m
};

/// Tip centres along random smooth slides at 50 mm/s, one per millisecond; each slide begins above the
/// surface.
[[nodiscard]] std::vector<std::vector<Vec3>> waysOver(const MetaModel& model, const WayOptions& options);

}  // namespace palpate::bench
