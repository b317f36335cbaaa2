// SPDX-License-Identifier: Apache-2.0
#include "tools/solver/build/domain_rings.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace palpate::solver {
namespace {

/// A strip of triangles: nodes 2 i and 2 i + 1 are a rung, the next rung is one ring away.
std::vector<std::array<std::int32_t, 3>> strip(std::int32_t rungs) {
  std::vector<std::array<std::int32_t, 3>> triangles;
  for (std::int32_t n = 0; n + 2 < 2 * rungs; ++n) triangles.push_back({n, n + 1, n + 2});
  return triangles;
}

TEST(TwoRings, ASmallRadiusReachesTwoRingsAndNoFurther) {
  std::vector<std::int32_t> nodes;
  for (std::int32_t n = 0; n < 14; ++n) nodes.push_back(n);
  std::vector<double> radii(14, 5.0);
  radii[6] = 1.0;
  // In the strip node n shares a triangle with n - 2 .. n + 2.
  const std::vector<double> wanted{5, 5, 1, 1, 1, 1, 1, 1, 1, 1, 1, 5, 5, 5};
  EXPECT_EQ(leastWithinTwoRings(strip(7), nodes, radii), wanted);
}

TEST(TwoRings, NodesWithoutAPositionLimitNobodyButPassTheirNeighboursOn) {
  const std::vector<std::int32_t> nodes{4, 0, 9};  // any order; 0 and 4 are two rings apart
  EXPECT_EQ(leastWithinTwoRings(strip(5), nodes, std::vector<double>{3.0, 2.0, 7.0}),
            (std::vector<double>{2.0, 2.0, 7.0}));
}

TEST(TwoRings, AMixOverATriangleStaysWithinAllPositionsThatItMixes) {
  std::vector<std::int32_t> nodes;
  std::vector<double> radii;
  for (std::int32_t n = 0; n < 20; ++n) {
    nodes.push_back(n);
    radii.push_back(1.0 + (n * 7 % 11));
  }
  const auto triangles = strip(10);
  const std::vector<double> least = leastWithinTwoRings(triangles, nodes, radii);
  for (const auto& t : triangles) {
    double mixed = 0.0;  // the largest of any linear mix
    for (const std::int32_t corner : t) mixed = std::max(mixed, least[static_cast<std::size_t>(corner)]);
    for (const auto& other : triangles) {
      const bool beside = std::any_of(t.begin(), t.end(), [&](std::int32_t corner) {
        return std::find(other.begin(), other.end(), corner) != other.end();
      });
      if (!beside) continue;
      for (const std::int32_t node : other) {
        EXPECT_LE(mixed, radii[static_cast<std::size_t>(node)]);
      }
    }
  }
}

}  // namespace
}  // namespace palpate::solver
