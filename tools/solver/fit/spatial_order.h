// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "tools/solver/fem/fe_model.h"

namespace palpate::solver {

/// Indices of the places in an order in which any stretch of neighbours lies close together: halves along the longest
/// extent, then halves of those, down to single places.
[[nodiscard]] std::vector<std::int32_t> spatialOrder(std::span<const Vec3> places);

}  // namespace palpate::solver
