// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tools/examine/query/full_solution.h"

namespace palpate::certify {

/// What has to be zero whatever the organ, computed on the organ of a model file. All are shares, zero but for rounding.
struct ChecksInPlace {
  double rotation{
      0.0};  ///< largest nodal force after a rotation by 30 degrees, over that after a stretch by 10 %
  double resultant{0.0};  ///< |sum of the nodal forces| after that stretch, over the sum of their sizes
};

/// Of the body without its springs, which a rotation stretches. Cost three evaluations of the internal force.
[[nodiscard]] ChecksInPlace checkedInPlace(const query::Organ& organ);

}  // namespace palpate::certify
