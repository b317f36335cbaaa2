// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "core/base/types.h"

namespace palpate {

/// |v|, also where |v|^2 overflows. The same bits wherever v lies in memory, which a replay of a session needs:
/// Eigen's stableNorm() sums from the first aligned number on. Real-time: yes.
[[nodiscard]] inline double lengthOf(const Vec3& v) noexcept PALPATE_NONBLOCKING {
  return std::hypot(v.x(), v.y(), v.z());
}

}  // namespace palpate
