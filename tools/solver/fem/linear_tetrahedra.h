// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "tools/solver/fem/integration_point.h"
#include "tools/solver/fem/material.h"

namespace palpate::solver {

/// One point for each tetrahedron, in their order: gradients are constant within.
/// @throw std::invalid_argument naming the element that is degenerate or has a node out of range
[[nodiscard]] std::vector<IntegrationPoint<4>> linearTetrahedra(
    std::span<const Vec3> nodes, std::span<const std::array<std::int32_t, 4>> tetrahedra,
    const Material& material);

}  // namespace palpate::solver
