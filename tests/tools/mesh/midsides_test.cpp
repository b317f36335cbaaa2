// SPDX-License-Identifier: Apache-2.0
#include "tools/mesh/midsides.h"

#include "core/base/index.h"
#include "helpers.h"
#include "tools/mesh/box_mesh.h"
#include "tools/mesh/checks.h"
#include "tools/mesh/quadratic.h"
#include "tools/mesh/topology.h"

namespace palpate::mesh::test {
namespace {

TetMesh box() {
  return quadraticOf(makeBox({0.1, 0.2, 0.3}, {2, 3, 4}));
}

TEST(Midsides, OfARaisedMeshAreInOrder) {
  EXPECT_NO_THROW(checkMesh(box()));
}

TEST(Midsides, AreMovedOntoStraightEdges) {
  TetMesh mesh = box();
  const TetMesh straight = mesh;
  mesh.nodes[index(mesh.midsides[3][1])].x() += 0.004;
  mesh.nodes[index(mesh.midsides[9][4])].z() -= 0.007;
  mesh.nodes[index(mesh.midsides[20][0])].y() += 1e-7;  // rounding in a file of six digits
  const CurvedEdges curved = straighten(mesh);
  EXPECT_EQ(curved.count, 2U);
  EXPECT_NEAR(curved.farthest, 0.007, 1e-12);
  EXPECT_EQ(mesh.nodes, straight.nodes);
  EXPECT_EQ(straighten(mesh).count, 0U);
}

TEST(Midsides, OfAnotherOrderAreRefused) {
  TetMesh mesh = box();
  for (auto& m : mesh.midsides) std::swap(m[4], m[5]);  // Gmsh's order
  EXPECT_REFUSED(checkMesh(mesh), "mid-side node", "tetrahedron");
}

TEST(Midsides, OffTheMiddleAreRefusedByNumberAndDistance) {
  TetMesh mesh = box();
  const std::int32_t node = mesh.midsides[3][1];
  mesh.nodes[index(node)].x() += 0.004;
  const std::string named = "node " + std::to_string(mesh.node_tags[index(node)]);
  EXPECT_REFUSED(checkMesh(mesh), named.c_str(), "is 4 mm off");
  mesh.nodes[index(node)].x() = 0.0 / 0.0;
  EXPECT_REFUSED(checkMesh(mesh), "not finite");
}

TEST(Midsides, ThatAreACornerOrOnTwoEdgesAreRefused) {
  TetMesh mesh = quadraticOf(oneTetrahedron());
  mesh.midsides[0][0] = mesh.midsides[0][1];
  EXPECT_REFUSED(checkMidsides(mesh), "middle of another edge");
  mesh.midsides[0][0] = mesh.tetrahedra[0][2];
  EXPECT_REFUSED(checkMidsides(mesh), "is a corner");
}

TEST(Midsides, ThatNeighboursDoNotShareAreRefused) {
  TetMesh mesh = box();
  mesh.nodes.push_back(mesh.nodes[index(mesh.midsides[0][2])]);
  mesh.node_tags.push_back(4711);
  mesh.midsides[0][2] = static_cast<std::int32_t>(mesh.nodes.size() - 1);  // crosses the cell: six share it
  EXPECT_REFUSED(checkMesh(mesh), "node 4711 of tetrahedron 1", "on the same edge");
}

TEST(Midsides, OutOfRangeOrMissingAreRefused) {
  TetMesh mesh = box();
  mesh.midsides[2][5] = 999;
  EXPECT_REFUSED(checkMesh(mesh), "tetrahedron 3 refers to node index 999");
  mesh.midsides.pop_back();
  EXPECT_REFUSED(checkMesh(mesh), "36 tetrahedra, 35 of them with mid-side nodes");
}

TEST(Midsides, FollowTheirEdgesWhenTetrahedraAreTurnedOver) {
  TetMesh inverted = makeBox({1, 1, 1}, {3, 3, 3});
  for (auto& t : inverted.tetrahedra) std::swap(t[0], t[3]);
  TetMesh mesh = quadraticOf(inverted);
  ASSERT_TRUE(reorientIfAllNegative(mesh));
  EXPECT_NO_THROW(checkMesh(mesh));
}

}  // namespace
}  // namespace palpate::mesh::test
