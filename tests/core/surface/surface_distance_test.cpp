// SPDX-License-Identifier: Apache-2.0
#include "core/surface/surface_distance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace palpate {
namespace {

constexpr std::int32_t kRow = 41;   // nodes; node (i, j) is 41 i + j
constexpr double kSpacing = 0.004;  // m

/// A square of 40 x 40 cells, in which many nodes are equally far away.
SurfaceGraph flatSquare() {
  std::vector<double> positions;
  std::vector<std::int32_t> triangles;
  for (int i = 0; i < kRow; ++i)
    for (int j = 0; j < kRow; ++j) positions.insert(positions.end(), {kSpacing * i, kSpacing * j, 0.0});
  for (std::int32_t i = 0; i + 1 < kRow; ++i)
    for (std::int32_t j = 0; j + 1 < kRow; ++j) {
      const std::int32_t a = kRow * i + j, b = a + kRow;
      triangles.insert(triangles.end(), {a, b, b + 1, a, b + 1, a + 1});
    }
  return {positions, triangles};
}

bool isNearer(const SurfaceFront::NodeDistance& l, const SurfaceFront::NodeDistance& r) {
  return l.second < r.second || (l.second == r.second && l.first < r.first);
}

TEST(SurfaceDistance, NodesComeNearestFirstAndEachOnce) {
  const SurfaceGraph graph = flatSquare();
  SurfaceFront front(graph);
  for (const std::int32_t centre : {0, 20, kRow * 20 + 20, kRow * kRow - 1}) {
    const std::vector<SurfaceFront::NodeDistance> all = front.from(graph.atNode(centre), 1.0);
    EXPECT_TRUE(std::is_sorted(all.begin(), all.end(), isNearer)) << centre;
    std::set<std::int32_t> nodes;
    std::size_t ties = 0;
    for (std::size_t i = 0; i < all.size(); ++i) {
      nodes.insert(all[i].first);
      ties += i > 0 && all[i].second == all[i - 1].second ? 1 : 0;
      const double straight = (graph.position(all[i].first) - graph.position(centre)).norm();
      EXPECT_GE(all[i].second, straight - 1e-12);
      EXPECT_NEAR(all[i].second, straight, 0.01 * straight + 1e-12) << all[i].first << " from " << centre;
    }
    EXPECT_EQ(nodes.size(), std::size_t{kRow * kRow});
    EXPECT_EQ(all.size(), nodes.size());
    EXPECT_GT(ties, 40U);
  }
}

TEST(SurfaceDistance, ASmallerBoundGivesTheNearestOfThem) {
  const SurfaceGraph graph = flatSquare();
  SurfaceFront front(graph);
  const ContactPoint s{kRow * kRow, {0.3, 0.5, 0.2}};
  const std::vector<SurfaceFront::NodeDistance> far = front.from(s, 0.05), near = front.from(s, 0.02);
  ASSERT_GT(near.size(), 50U);
  ASSERT_GT(far.size(), 4 * near.size());
  EXPECT_LT(near.back().second, 0.02);
  EXPECT_GE(far[near.size()].second, 0.02);
  EXPECT_TRUE(std::equal(near.begin(), near.end(), far.begin()));
  EXPECT_EQ(front.from(s, 0.05), far) << "of the same front";
  EXPECT_TRUE(front.from(s, 0.0).empty());
}

}  // namespace
}  // namespace palpate
