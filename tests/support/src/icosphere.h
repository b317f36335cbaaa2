// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/base/types.h"

namespace palpate::testing {

struct Icosphere {
  std::vector<Vec3> nodes;                             ///< on the unit sphere
  std::vector<std::array<std::int32_t, 3>> triangles;  ///< counter-clockwise from outside
};

[[nodiscard]] Icosphere icosphere(int subdivisions);

}  // namespace palpate::testing
