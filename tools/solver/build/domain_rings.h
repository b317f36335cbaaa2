// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace palpate::solver {

/// For each contact position the smallest radius within two rings of triangles around it. An answer in a triangle
/// mixes positions up to one ring from its corners; with this the linear mix of d_max over the triangle is
/// within what each of them answers.                                  docs/design.md, Series
/// @param triangles  of surface nodes  @param nodes  surface node of each position  @param radii  one per position
[[nodiscard]] std::vector<double> leastWithinTwoRings(std::span<const std::array<std::int32_t, 3>> triangles,
                                                      std::span<const std::int32_t> nodes,
                                                      std::span<const double> radii);

}  // namespace palpate::solver
