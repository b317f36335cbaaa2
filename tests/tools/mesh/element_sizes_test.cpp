// SPDX-License-Identifier: Apache-2.0
#include "tools/mesh/element_sizes.h"

#include <algorithm>
#include <random>

#include "helpers.h"
#include "tools/mesh/box_mesh.h"
#include "tools/mesh/topology.h"

namespace palpate::mesh::test {
namespace {

TEST(InnerSizes, GrowWithTheDistanceUpToTheLargest) {
  const std::vector<Eigen::Vector3d> nodes{{0, 0, 0}, {0.01, 0, 0}, {0, 0.01, 0}, {9, 9, 9}};
  const InnerSizes sizes(nodes, {{0, 1, 2}}, {0.01, 0.03, 0.5});
  EXPECT_DOUBLE_EQ(sizes.at({0, 0, 0}), 0.01);  // two edges of 10 mm
  EXPECT_NEAR(sizes.at({0, 0, 0.01}), 0.015, 1e-15);
  EXPECT_NEAR(sizes.at({-0.02, 0, 0}), 0.02, 1e-15);
  EXPECT_NEAR(sizes.at({0, 0, -0.039}), 0.0295, 1e-15);
  EXPECT_EQ(sizes.at({0, 0, 0.06}), 0.03);
  EXPECT_EQ(sizes.at({9, 9, 9}), 0.03);  // in no triangle
}

// What cells leave out lies farther than the largest size needs.
TEST(InnerSizes, AreTheLeastOverAllNodes) {
  const TetMesh box = makeBox({0.1, 0.2, 0.3}, {7, 5, 9});
  const BoundarySurface boundary = boundaryOf(box);
  std::vector<Eigen::Vector3d> nodes;
  for (const auto node : boundary.nodes) nodes.push_back(box.nodes[static_cast<std::size_t>(node)]);
  const InnerSizes sizes(nodes, boundary.faces, {0.03, 0.09, 0.7});
  const InnerSizes at_nodes(nodes, boundary.faces, {0.03, 1, 0.7});
  std::mt19937 random(1);
  std::uniform_real_distribution<double> in_box(-0.1, 0.4);
  int below = 0;
  for (int i = 0; i < 500; ++i) {
    const Eigen::Vector3d x(in_box(random), in_box(random), in_box(random));
    double wanted = 0.09;
    for (const auto& node : nodes) wanted = std::min(wanted, at_nodes.at(node) + 0.7 * (x - node).norm());
    EXPECT_DOUBLE_EQ(sizes.at(x), wanted);
    below += wanted < 0.09 ? 1 : 0;
  }
  EXPECT_GT(below, 50);
  EXPECT_LT(below, 450);
}

}  // namespace
}  // namespace palpate::mesh::test
