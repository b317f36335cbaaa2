// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>

namespace palpate::modelfile {

/// The contact positions of a model, as its file holds them.
struct Positions {
  std::span<const double> surface_positions;        ///< [Ns][3] m
  std::span<const std::int32_t> contact_triangles;  ///< [Tc][3]
  std::span<const std::int32_t> position_of_node;   ///< [Ns] or -1
  std::span<const std::uint8_t> accessible;         ///< [M]
};

/// The part of the accessible surface from which a tool may go at least so far: of the area of positions, a third of each of
/// their triangles.
/// @param radius  [M] m, such as d_max  @param travel  m  @return 0 to 1; 0 where nothing is accessible
[[nodiscard]] double reachingPart(const Positions& positions, std::span<const double> radius, double travel);

/// Travels that people press by, and the parts that reach them.
struct Reach {
  double travel;          ///< m
  double domain, series;  ///< parts by d_max and by r_max, 0 to 1
};
/// 7, 10 and 15 mm. @param domain, series  [M] d_max and r_max, m
[[nodiscard]] std::array<Reach, 3> reachOf(const Positions& positions, std::span<const double> domain,
                                           std::span<const double> series);

}  // namespace palpate::modelfile
