// SPDX-License-Identifier: Apache-2.0
#include "tools/examine/bench/ellipsoid.h"

#include <cmath>
#include <numbers>

namespace palpate::bench {

namespace {

/// A ring of latitude: its first node and how many it has. A pole is a ring of one.
struct Ring {
  std::int32_t first, count;
  [[nodiscard]] std::int32_t node(std::int32_t i) const { return first + i % count; }
};

/// Rings with node counts in proportion to their lengths. Rounding the running sum makes the total exact.
std::vector<Ring> ringsOf(int nodes, int between) {
  double whole = 0.0, sum = 0.0;
  for (int r = 1; r <= between; ++r) whole += std::sin(std::numbers::pi * r / (between + 1));
  std::vector<Ring> rings{{0, 1}};
  std::int32_t taken = 0;
  for (int r = 1; r <= between; ++r) {
    sum += std::sin(std::numbers::pi * r / (between + 1));
    const auto upto = static_cast<std::int32_t>(std::lround((nodes - 2) * sum / whole));
    rings.push_back({1 + taken, upto - taken});
    taken = upto;
  }
  rings.push_back({nodes - 1, 1});
  return rings;
}

/// Triangles between a ring and the one below it: the ring whose next node comes first advances.
void stitch(const Ring& upper, const Ring& lower, std::vector<std::array<std::int32_t, 3>>& triangles) {
  const std::int32_t ends_up = upper.count > 1 ? upper.count : 0,
                     ends_low = lower.count > 1 ? lower.count : 0;
  std::int32_t i = 0, j = 0;
  while (i < ends_up || j < ends_low) {
    const bool up = j == ends_low || (i < ends_up && (i + 1) * lower.count < (j + 1) * upper.count);
    triangles.push_back({upper.node(i), lower.node(j), up ? upper.node(i + 1) : lower.node(j + 1)});
    ++(up ? i : j);
  }
}

}  // namespace

Ellipsoid ellipsoid(int nodes, const Vec3& semi_axes) {
  const double spacing = std::sqrt(4.0 * std::numbers::pi / nodes);  // on the unit sphere
  const int between = static_cast<int>(std::lround(std::numbers::pi / spacing)) - 1;
  const std::vector<Ring> rings = ringsOf(nodes, between);
  Ellipsoid out;
  for (std::size_t r = 0; r < rings.size(); ++r) {
    const double theta = std::numbers::pi * static_cast<double>(r) / (between + 1);
    for (std::int32_t i = 0; i < rings[r].count; ++i) {
      const double phi = 2.0 * std::numbers::pi * i / rings[r].count;
      const Vec3 unit(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta));
      out.nodes.emplace_back(semi_axes.cwiseProduct(unit));
    }
    if (r > 0) stitch(rings[r - 1], rings[r], out.triangles);
  }
  return out;
}

}  // namespace palpate::bench
