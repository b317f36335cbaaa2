// SPDX-License-Identifier: Apache-2.0
#include "tools/mesh/quadratic.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <set>

#include "core/base/index.h"
#include "helpers.h"
#include "tools/mesh/box_mesh.h"
#include "tools/mesh/topology.h"

namespace palpate::mesh::test {
namespace {

TetMesh boxClampedAtX0() {
  TetMesh box = makeBox({1, 2, 3}, {2, 3, 4});
  for (std::size_t i = 0; i < box.nodes.size(); ++i)
    if (box.nodes[i].x() == 0.0) box.groups["fixed"].push_back(static_cast<std::int32_t>(i));
  return box;
}

class QuadraticMesh : public ::testing::Test {
 protected:
  const TetMesh linear_ = boxClampedAtX0();
  const TetMesh mesh_ = quadraticOf(linear_);
};

TEST_F(QuadraticMesh, HasANodeInTheMiddleOfEachEdge) {
  std::set<std::pair<std::int32_t, std::int32_t>> edges;
  ASSERT_EQ(mesh_.midsides.size(), linear_.tetrahedra.size());
  for (std::size_t t = 0; t < mesh_.tetrahedra.size(); ++t)
    for (std::size_t e = 0; e < 6; ++e) {
      const auto a = mesh_.tetrahedra[t][index(kTetEdges[e][0])],
                 b = mesh_.tetrahedra[t][index(kTetEdges[e][1])];
      edges.insert(std::minmax(a, b));
      EXPECT_EQ(mesh_.nodes[index(mesh_.midsides[t][e])],
                0.5 * (mesh_.nodes[index(a)] + mesh_.nodes[index(b)]));
    }
  EXPECT_EQ(mesh_.nodes.size(), linear_.nodes.size() + edges.size());
  const std::set<std::int64_t> tags(mesh_.node_tags.begin(), mesh_.node_tags.end());
  EXPECT_EQ(tags.size(), mesh_.nodes.size());
  EXPECT_TRUE(std::equal(linear_.node_tags.begin(), linear_.node_tags.end(), mesh_.node_tags.begin()));
}

TEST_F(QuadraticMesh, AGroupTakesTheMiddlesBetweenItsNodes) {
  const auto& fixed = linear_.groups.at("fixed");
  const auto& all = mesh_.groups.at("fixed");
  EXPECT_EQ(fixed.size(), 3U * 4U);
  EXPECT_EQ(all.size(), 5U * 7U);
  EXPECT_TRUE(std::is_sorted(all.begin(), all.end()));
  for (const std::int32_t node : all) EXPECT_EQ(mesh_.nodes[index(node)].x(), 0.0);
}

// The diagonal of a cell joins two nodes of the surface through the inside.
TEST(QuadraticGroups, OfSurfaceNodesStayOnTheSurface) {
  TetMesh cell = makeBox({1, 1, 1}, {2, 2, 2});
  cell.nodes.emplace_back(0.5, 0.5, -0.5);  // a ninth node, so that the eight are a part
  cell.node_tags.push_back(9);
  cell.tetrahedra.push_back({0, 1, 3, 8});
  cell.tetrahedron_tags.push_back(7);
  cell.groups["skin"] = {0, 1, 2, 3, 4, 5, 6, 7};
  cell.groups["tissue"] = cell.groups["skin"];
  cell.regions["tissue"] = {0, 1, 2, 3, 4, 5};
  const TetMesh mesh = quadraticOf(cell);
  EXPECT_EQ(mesh.groups.at("tissue").size(), 8U + 19U);
  EXPECT_EQ(mesh.groups.at("skin").size(), 8U + 18U);
  for (const auto node : mesh.groups.at("skin"))
    EXPECT_NE(mesh.nodes[index(node)], Eigen::Vector3d(0.5, 0.5, 0.5));
}

TEST_F(QuadraticMesh, EachFaceOfTheBoundaryIsFourFlatTriangles) {
  const BoundarySurface old = boundaryOf(linear_), boundary = boundaryOf(mesh_);
  ASSERT_EQ(boundary.faces.size(), old.triangles.size());
  ASSERT_EQ(boundary.triangles.size(), 4 * old.triangles.size());
  EXPECT_EQ(old.faces, old.triangles);
  const auto normalOf = [&](const std::array<std::int32_t, 3>& t) -> Eigen::Vector3d {
    const auto x = [&](std::size_t i) { return mesh_.nodes[index(boundary.nodes[index(t[i])])]; };
    return (x(1) - x(0)).cross(x(2) - x(0)) / 2;
  };
  for (std::size_t f = 0; f < boundary.faces.size(); ++f) {
    const Eigen::Vector3d whole = normalOf(boundary.faces[f]);
    for (std::size_t part = 0; part < 4; ++part)
      EXPECT_LT((normalOf(boundary.triangles[4 * f + part]) - 0.25 * whole).norm(), 1e-14);
  }
}

}  // namespace
}  // namespace palpate::mesh::test
