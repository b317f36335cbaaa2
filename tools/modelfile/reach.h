// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "tools/program/json.h"

namespace palpate::modelfile {

/// The contact positions of a model, as its file holds them.
struct Positions {
  std::span<const double> surface_positions;        ///< [Ns][3] m
  std::span<const std::int32_t> contact_triangles;  ///< [Tc][3]
  std::span<const std::int32_t> position_of_node;   ///< [Ns] or -1
  std::span<const std::uint8_t> accessible;         ///< [M]
};

/// Share of the accessible surface from which a tool may go at least so far: of the area of positions, a third of each of
/// their triangles.
/// @param radius  [M] m, such as d_max  @param travel  m  @return 0 to 1; 0 where nothing is accessible
[[nodiscard]] double reachingShare(const Positions& positions, std::span<const double> radius, double travel);

/// The part of touches with abs(d) uniform in 0.2 to 1 of a travel, as palpate-certify draws them, that is within a radius.
/// @param radius, travel  m, travel > 0
[[nodiscard]] double touchWithin(double radius, double travel);

/// Share of touches on the accessible surface that are within a radius: the mean of touchWithin() over the area.
/// @param radius  [M] m  @param travel  m  @return 0 to 1; 0 where nothing is accessible
[[nodiscard]] double touchesWithin(const Positions& positions, std::span<const double> radius, double travel);

/// How far each side goes, by where the outward normal points most: a list of {"side": "+x", "area_share", "median" (d_max, m),
/// "reaching" (share of the side's area), "touches" (touchesWithin())}; sides without area are left out.      docs/json.md
[[nodiscard]] program::Json sidesJson(const Positions& positions, std::span<const double> radius,
                                      double travel);

/// A travel that people press by, and the shares that reach it.
struct Reach {
  double travel;          ///< m
  double domain, series;  ///< shares by d_max and by r_max, 0 to 1
};
/// 7, 10 and 15 mm. @param domain, series  [M] d_max and r_max, m
[[nodiscard]] std::array<Reach, 3> reachOf(const Positions& positions, std::span<const double> domain,
                                           std::span<const double> series);

/// The same for --json: a list of {"travel", "by_domain_radius", "by_series_radius"}.                        docs/json.md
[[nodiscard]] program::Json reachJson(const Positions& positions, std::span<const double> domain,
                                      std::span<const double> series);

/// {"min", "p05", "median", "max"} of a radius over the accessible positions; null where there are none.
/// @param accessible, radius  [M]
[[nodiscard]] program::Json radiusJson(std::span<const std::uint8_t> accessible,
                                       std::span<const double> radius);

}  // namespace palpate::modelfile
