// SPDX-License-Identifier: Apache-2.0
#include "tools/mesh/checks.h"

#include <limits>

#include "helpers.h"
#include "tools/mesh/box_mesh.h"
#include "tools/mesh/topology.h"

namespace palpate::mesh::test {
namespace {

void addNode(TetMesh& mesh, const Eigen::Vector3d& x, std::int64_t tag) {
  mesh.nodes.push_back(x);
  mesh.node_tags.push_back(tag);
}

void addTetrahedron(TetMesh& mesh, const std::array<std::int32_t, 4>& nodes, std::int64_t tag) {
  mesh.tetrahedra.push_back(nodes);
  mesh.tetrahedron_tags.push_back(tag);
}

// A second tetrahedron on the face of nodes 1, 2, 3.
TetMesh twoTetrahedra() {
  TetMesh mesh = oneTetrahedron();
  addNode(mesh, {1, 1, 1}, 15);
  addTetrahedron(mesh, {1, 2, 3, 4}, 8);
  return mesh;
}

TEST(CheckMesh, TakesOneAndTwoTetrahedra) {
  EXPECT_NO_THROW(checkMesh(oneTetrahedron()));
  EXPECT_NO_THROW(checkMesh(twoTetrahedra()));
}

TEST(CheckMesh, RefusesEmptyMesh) {
  EXPECT_REFUSED(checkMesh(TetMesh{}), "no tetrahedra");
}

TEST(CheckMesh, RefusesArraysOfDifferentSizes) {
  TetMesh mesh = oneTetrahedron();
  mesh.node_tags.pop_back();
  EXPECT_REFUSED(checkMesh(mesh), "4 nodes with 3 numbers");
}

TEST(CheckMesh, RefusesIndexOutOfRange) {
  TetMesh mesh = oneTetrahedron();
  mesh.tetrahedra[0][2] = 4;
  EXPECT_REFUSED(checkMesh(mesh), "tetrahedron 7", "index 4");
}

TEST(CheckMesh, RefusesNonFiniteCoordinate) {
  for (const double wrong :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    TetMesh mesh = oneTetrahedron();
    mesh.nodes[2].y() = wrong;
    EXPECT_REFUSED(checkMesh(mesh), "node 13", "not finite");
  }
}

TEST(CheckMesh, RefusesUnreferencedNode) {
  TetMesh mesh = oneTetrahedron();
  addNode(mesh, {2, 2, 2}, 99);
  EXPECT_REFUSED(checkMesh(mesh), "node 99", "belongs to no tetrahedron");
}

TEST(CheckMesh, RefusesRepeatedCorner) {
  TetMesh mesh = twoTetrahedra();
  mesh.tetrahedra[1] = {1, 2, 4, 4};
  EXPECT_REFUSED(checkMesh(mesh), "tetrahedron 8", "node 15 twice");
}

TEST(CheckMesh, RefusesFlatTetrahedron) {
  TetMesh mesh = oneTetrahedron();
  mesh.nodes[3] = {0.3, 0.3, 1e-10};
  EXPECT_REFUSED(checkMesh(mesh), "tetrahedron 7", "flat (volume 0.0167 mm^3)");
  for (auto& x : mesh.nodes) x *= 1e-6;
  EXPECT_REFUSED(checkMesh(mesh), "tetrahedron 7", "flat (volume 1.67e-20 mm^3)");
}

TEST(CheckMesh, JudgesFlatnessWhateverTheUnit) {
  TetMesh mesh = oneTetrahedron();
  for (auto& x : mesh.nodes) x *= 1e-6;
  EXPECT_NO_THROW(checkMesh(mesh));
}

TEST(CheckMesh, RefusesOneInvertedTetrahedron) {
  TetMesh mesh = twoTetrahedra();
  std::swap(mesh.tetrahedra[1][2], mesh.tetrahedra[1][3]);
  EXPECT_FALSE(reorientIfAllNegative(mesh));
  EXPECT_REFUSED(checkMesh(mesh), "tetrahedron 8", "inverted (volume -3.33e+08 mm^3)");
}

TEST(CheckMesh, TurnsAMeshOverThatIsAllInverted) {
  TetMesh mesh = twoTetrahedra();
  for (auto& t : mesh.tetrahedra) std::swap(t[2], t[3]);
  EXPECT_TRUE(reorientIfAllNegative(mesh));
  EXPECT_NO_THROW(checkMesh(mesh));
}

TEST(CheckMesh, RefusesDuplicateTetrahedron) {
  TetMesh mesh = oneTetrahedron();
  addTetrahedron(mesh, {1, 2, 0, 3}, 23);
  EXPECT_REFUSED(checkMesh(mesh), "tetrahedron 23", "same nodes as tetrahedron 7");
}

TEST(CheckMesh, RefusesFaceOfThreeTetrahedra) {
  TetMesh mesh = twoTetrahedra();
  addNode(mesh, {2, 2, 2}, 16);
  addTetrahedron(mesh, {1, 2, 3, 5}, 9);
  EXPECT_REFUSED(checkMesh(mesh), "face of nodes 12 13 14", "more than two", "tetrahedron 9");
}

TEST(CheckMesh, RefusesTetrahedraOnTheSameSideOfTheirFace) {
  TetMesh mesh = oneTetrahedron();
  addNode(mesh, {0.1, 0.1, 0.1}, 15);
  addTetrahedron(mesh, {4, 1, 2, 3}, 8);
  EXPECT_REFUSED(checkMesh(mesh), "tetrahedron 8", "tetrahedron 7", "overlap");
}

TEST(CheckMesh, RefusesDisconnectedParts) {
  TetMesh mesh = twoTetrahedra();
  for (int i = 0; i < 4; ++i)
    addNode(mesh, mesh.nodes[static_cast<std::size_t>(i)] + Eigen::Vector3d(5, 0, 0), 20 + i);
  addTetrahedron(mesh, {5, 6, 7, 8}, 44);
  EXPECT_REFUSED(checkMesh(mesh), "disconnected", "tetrahedron 44", "a part of 1");
}

TEST(CheckMesh, RefusesBoundaryEdgeInFourTriangles) {
  // A ring of three cells around an edge with the fourth quadrant closed only by that edge: two cells that
  // touch along it, joined by a third layer above.
  TetMesh mesh = makeBox({2, 2, 2}, {3, 3, 3});
  std::vector<std::array<std::int32_t, 4>> kept;
  for (const auto& t : mesh.tetrahedra) {
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();
    for (const auto node : t) centre += mesh.nodes[static_cast<std::size_t>(node)] / 4;
    // Below, only two cells on a diagonal remain: they touch along the vertical middle edge.
    if (centre.z() > 1 || (centre.x() > 1) == (centre.y() > 1)) kept.push_back(t);
  }
  mesh.tetrahedra = kept;
  mesh.tetrahedron_tags.resize(kept.size());
  std::vector<std::int32_t> used(mesh.nodes.size(), -1);
  TetMesh packed;
  for (auto& t : mesh.tetrahedra) {
    for (auto& node : t) {
      auto& index = used[static_cast<std::size_t>(node)];
      if (index < 0) {
        index = static_cast<std::int32_t>(packed.nodes.size());
        addNode(packed, mesh.nodes[static_cast<std::size_t>(node)], node + 1);
      }
      node = index;
    }
    addTetrahedron(packed, t, 1);
  }
  // The lower end of that edge is the middle of the bottom, node 5; its upper end the box's centre, node 14.
  EXPECT_REFUSED(checkMesh(packed), "not a manifold", "node 5", "node 14", "4 triangles");
}

TEST(CheckMesh, RefusesBoundaryVertexOfTwoFans) {
  // A ring of tetrahedra closed face to face, bent so that two of them touch in one vertex: take a box of
  // four cells in a row and identify a corner node of the last cell with one of the first.
  TetMesh mesh = makeBox({6, 1, 1}, {7, 2, 2});
  const std::int32_t first = 0;
  const std::int32_t last = 6;  // (6, 0, 0)
  const double pi = 3.14159265358979;
  for (auto& x : mesh.nodes) {  // bend by a full turn around an axis below the bar
    const double angle = x.x() / 6 * 1.9 * pi;
    const double radius = 2 + x.z();
    x = {radius * std::sin(angle), x.y(), radius * std::cos(angle)};
  }
  mesh.nodes[static_cast<std::size_t>(last)] = mesh.nodes[static_cast<std::size_t>(first)];
  for (auto& t : mesh.tetrahedra) {
    for (auto& node : t) node = node == last ? first : node > last ? node - 1 : node;
  }
  mesh.nodes.erase(mesh.nodes.begin() + last);
  mesh.node_tags.erase(mesh.node_tags.begin() + last);
  reorientIfAllNegative(mesh);
  EXPECT_REFUSED(checkMesh(mesh), "not a manifold", "node 1 joins several fans");
}

TEST(CheckHeld, ThreeNodesOffOneLineHoldTheOrgan) {
  TetMesh mesh = oneTetrahedron();
  mesh.groups["fixed"] = {0, 1, 3};
  EXPECT_NO_THROW(checkHeld(mesh, "fixed"));
}

TEST(CheckHeld, RefusesWhatLeavesARigidMotion) {
  TetMesh mesh = makeBox({1, 1, 1}, {4, 4, 4});
  mesh.groups["pair"] = {0, 1};
  mesh.groups["edge"] = {0, 1, 2, 3};
  EXPECT_REFUSED(checkHeld(mesh, "pair"), "group 'pair': 2 nodes do not hold", "at least 3");
  EXPECT_REFUSED(checkHeld(mesh, "edge"), "group 'edge': 4 nodes lie on one line");
  EXPECT_REFUSED(checkHeld(mesh, "none"), "no group 'none'");
}

TEST(CheckHeld, JudgesTheLineWhateverTheUnit) {
  TetMesh mesh = oneTetrahedron();
  mesh.groups["fixed"] = {0, 1, 3};
  for (auto& x : mesh.nodes) x *= 1e-6;
  EXPECT_NO_THROW(checkHeld(mesh, "fixed"));
}

}  // namespace
}  // namespace palpate::mesh::test
