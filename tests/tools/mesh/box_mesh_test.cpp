// SPDX-License-Identifier: Apache-2.0
#include "tools/mesh/box_mesh.h"

#include <Eigen/Geometry>
#include <algorithm>

#include "helpers.h"
#include "tools/mesh/checks.h"
#include "tools/mesh/topology.h"

namespace palpate::mesh::test {
namespace {

TEST(BoxMesh, BeamHasTheCountsOfTheDesign) {
  const TetMesh beam = makeBeam();
  EXPECT_EQ(beam.nodes.size(), 1701U);
  EXPECT_EQ(beam.tetrahedra.size(), 7680U);
  EXPECT_EQ(beam.groups.at("fixed").size(), 81U);
  EXPECT_EQ(beam.groups.at("accessible").size(), 689U);
  EXPECT_NO_THROW(checkMesh(beam));
}

TEST(BoxMesh, BeamFillsItsBoxExactly) {
  const TetMesh beam = makeBeam();
  double volume = 0;
  for (std::size_t t = 0; t < beam.tetrahedra.size(); ++t) volume += signedVolume(beam, t);
  EXPECT_NEAR(volume, 0.4 * 0.04 * 0.04, 1e-15);
  EXPECT_EQ(beam.nodes.back(), Eigen::Vector3d(0.4, 0.04, 0.04));
}

TEST(BoxMesh, EveryTetrahedronLiesOnTheDiagonalOfItsCell) {
  const TetMesh beam = makeBeam();
  ASSERT_FALSE(beam.tetrahedra.empty());
  for (const auto& t : beam.tetrahedra) {
    const auto [low, high] = std::minmax_element(t.begin(), t.end());
    const Eigen::Vector3d diagonal =
        beam.nodes[static_cast<std::size_t>(*high)] - beam.nodes[static_cast<std::size_t>(*low)];
    EXPECT_TRUE(diagonal.isApprox(Eigen::Vector3d(0.02, 0.005, 0.005), 1e-12));
  }
}

TEST(BoxMesh, BoundaryFacesOutwardAndCloses) {
  const TetMesh box = makeBox({1, 2, 3}, {3, 4, 5});
  const BoundarySurface boundary = boundaryOf(box);
  const Eigen::Vector3d centre(0.5, 1, 1.5);
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double area = 0;
  for (const auto& t : boundary.triangles) {
    const auto at = [&](std::size_t i) -> Eigen::Vector3d {
      return box.nodes[static_cast<std::size_t>(boundary.nodes[static_cast<std::size_t>(t[i])])];
    };
    const Eigen::Vector3d normal = (at(1) - at(0)).cross(at(2) - at(0)) / 2;
    EXPECT_GT(normal.dot(at(0) - centre), 0);
    sum += normal;
    area += normal.norm();
  }
  EXPECT_LT(sum.norm(), 1e-14);
  EXPECT_NEAR(area, 2 * (1 * 2 + 2 * 3 + 1 * 3), 1e-12);
}

TEST(BoxMesh, RefusesSizesAndCountsThatMakeNoBox) {
  EXPECT_REFUSED(makeBox({1, 0, 1}, {2, 2, 2}), "positive edge lengths");
  EXPECT_REFUSED(makeBox({1, 1, 1}, {2, 1, 2}), "at least 2 nodes", "not 1");
  EXPECT_REFUSED(makeBox({1, 1, 1}, {100000, 100000, 2}), "too large");
}

}  // namespace
}  // namespace palpate::mesh::test
