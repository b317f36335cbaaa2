// SPDX-License-Identifier: Apache-2.0
#include "tools/mesh/statistics.h"

#include <cmath>

#include "helpers.h"
#include "tools/mesh/box_mesh.h"
#include "tools/mesh/quadratic.h"
#include "tools/mesh/topology.h"

namespace palpate::mesh::test {
namespace {

TEST(Quality, IsOneForTheRegularAndZeroForTheFlatTetrahedron) {
  EXPECT_NEAR(quality({1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}), 1, 1e-14);
  EXPECT_EQ(quality({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}), 0);
}

TEST(Quality, OfTheCornerOfACubeIsKnown) {
  // Inscribed radius (3 - sqrt 3) / 6, circumscribed radius sqrt(3) / 2.
  EXPECT_NEAR(quality({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}), (3 - std::sqrt(3.0)) / std::sqrt(3.0),
              1e-14);
}

TEST(Statistics, OfABoxAreItsMeasures) {
  const TetMesh box = makeBox({1, 2, 3}, {2, 3, 4});
  const MeshStatistics s = statisticsOf(box, boundaryOf(box));
  EXPECT_EQ(s.nodes, 24U);
  EXPECT_EQ(s.tetrahedra, 36U);
  EXPECT_EQ(s.surface_nodes, 24U);
  EXPECT_EQ(s.surface_triangles, 44U);
  EXPECT_NEAR(s.volume, 6, 1e-13);
  EXPECT_EQ(s.box_min, Eigen::Vector3d(0, 0, 0));
  EXPECT_EQ(s.box_max, Eigen::Vector3d(1, 2, 3));
  EXPECT_NEAR(s.median_surface_edge, 1, 0.42);
  EXPECT_GT(s.mean_edge, 1);
  EXPECT_LT(s.mean_edge, std::sqrt(3.0));
}

TEST(Statistics, OfQuadraticElementsAreThoseOfTheirCorners) {
  const TetMesh box = makeBox({1, 2, 3}, {2, 3, 4});
  const TetMesh raised = quadraticOf(box);
  const MeshStatistics linear = statisticsOf(box, boundaryOf(box));
  const MeshStatistics s = statisticsOf(raised, boundaryOf(raised));
  EXPECT_EQ(linear.corners, 24U);
  EXPECT_EQ(s.corners, 24U);
  EXPECT_EQ(s.surface_corners, 24U);
  EXPECT_EQ(s.nodes, 24U + 81U);          // Euler: nodes - edges + faces - tetrahedra = 1, with 94 faces
  EXPECT_EQ(s.surface_nodes, 24U + 66U);  // 44 triangles have 66 edges
  EXPECT_EQ(s.surface_triangles, 44U);
  EXPECT_EQ(s.mean_edge, linear.mean_edge);
  EXPECT_EQ(s.median_surface_edge, linear.median_surface_edge);
  EXPECT_EQ(s.volume, linear.volume);
}

TEST(Statistics, NameTheWorstTetrahedronByItsNumber) {
  TetMesh mesh = oneTetrahedron();
  mesh.nodes.emplace_back(0.4, 0.4, 0.4);  // just outside the face of nodes 1, 2, 3
  mesh.node_tags.push_back(15);
  mesh.tetrahedra.push_back({1, 2, 3, 4});
  mesh.tetrahedron_tags.push_back(8);
  EXPECT_EQ(statisticsOf(mesh, boundaryOf(mesh)).worst_tetrahedron, 8);
}

}  // namespace
}  // namespace palpate::mesh::test
