// SPDX-License-Identifier: Apache-2.0
#include "tools/solver/fem/patch.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <numeric>

#include "../boxes.h"
#include "core/surface/surface_distance.h"

namespace palpate::solver {
namespace {

const Material kLiver{{160e3, 0.48}};

class Plate : public ::testing::Test {
 protected:
  const Box box_{20, 20, 1,
                 Vec3(0.1, 0.1, 0.002)};  // thin: both sides are near through space, not along the surface
  const FeModel model_{box_.clamped(kLiver)};
  const PatchSurface surface_{box_.surface(model_)};

  int surfaceNode(int volume_node) const {
    return static_cast<int>(std::find(surface_.nodes.begin(), surface_.nodes.end(), volume_node) -
                            surface_.nodes.begin());
  }
};

TEST_F(Plate, DistancesOnAFlatFaceAreStraight) {
  const int centre = surfaceNode(box_.node(10, 10, 1));
  const auto distances = SurfaceFront(surface_.graph).from(surface_.atNode(centre), 0.03);
  ASSERT_GT(distances.size(), 20U);
  for (const auto& [node, r] : distances) {
    const Vec3 gap = surface_.positions[static_cast<std::size_t>(node)] -
                     surface_.positions[static_cast<std::size_t>(centre)];
    EXPECT_NEAR(r, gap.norm(), 0.01 * gap.norm() + 1e-12) << gap.transpose();
  }
}

TEST_F(Plate, DistancesChangeContinuouslyOverAnEdge) {
  const auto& triangle = surface_.triangles[100];
  ContactPoint before{100, {0.4, 0.6, 0.0}};
  int other = -1;
  for (const int t : surface_.graph.trianglesOf(triangle[0]))
    if (t != 100 && std::count(surface_.triangles[static_cast<std::size_t>(t)].begin(),
                               surface_.triangles[static_cast<std::size_t>(t)].end(), triangle[1]) > 0)
      other = t;
  ASSERT_GE(other, 0);
  ContactPoint after{other, {}};
  for (std::size_t k = 0; k < 3; ++k) {
    const int node = surface_.triangles[static_cast<std::size_t>(other)][k];
    after.barycentric[k] = node == triangle[0] ? 0.4 : node == triangle[1] ? 0.6 : 0.0;
  }
  const auto a = SurfaceFront(surface_.graph).from(before, 0.03);
  const auto b = SurfaceFront(surface_.graph).from(after, 0.03);
  ASSERT_EQ(a.size(), b.size());
  std::map<int, double> by_node(a.begin(), a.end());
  ASSERT_GT(b.size(), 20U);
  for (const auto& [node, r] : b) EXPECT_NEAR(by_node[node], r, 1e-9);
}

TEST_F(Plate, PatchDoesNotReachThroughAThinLobe) {
  const Patch patch = makePatch(model_, surface_, surface_.atNode(surfaceNode(box_.node(10, 10, 1))), 0.005);
  ASSERT_GT(patch.nodes.size(), 1U);
  for (const int node : patch.nodes) EXPECT_EQ(node % 2, 1) << "node " << node << " lies on the other side";
}

TEST_F(Plate, WeightsSumToOneAndFallWithDistance) {
  const Patch patch = makePatch(model_, surface_, surface_.atNode(surfaceNode(box_.node(10, 10, 1))), 0.008);
  EXPECT_NEAR(std::accumulate(patch.weights.begin(), patch.weights.end(), 0.0), 1.0, 1e-12);
  EXPECT_NEAR(patch.free_share, 1.0, 1e-12);
  ASSERT_GT(patch.nodes.size(), 20U);
  const auto heaviest = std::max_element(patch.weights.begin(), patch.weights.end());
  EXPECT_EQ(patch.nodes[static_cast<std::size_t>(heaviest - patch.weights.begin())], box_.node(10, 10, 1));
  EXPECT_GT(*heaviest, 50.0 * *std::min_element(patch.weights.begin(), patch.weights.end()));
}

TEST_F(Plate, FixedNodesCarryNothing) {
  const Patch patch = makePatch(model_, surface_, surface_.atNode(surfaceNode(box_.node(1, 10, 1))), 0.008);
  for (const int node : patch.nodes) EXPECT_TRUE(model_.isFree(node));
  EXPECT_LT(patch.free_share, 0.9);
  EXPECT_NEAR(std::accumulate(patch.weights.begin(), patch.weights.end(), 0.0), 1.0, 1e-12);
}

}  // namespace
}  // namespace palpate::solver
