// SPDX-License-Identifier: Apache-2.0
#include <limits>

#include "helpers.h"
#include "tools/mesh/surface_defects.h"
#include "tools/mesh/surface_solids.h"
#include "tools/mesh/triangle_crossing.h"
#include "tools/mesh/triangle_surface.h"

namespace palpate::mesh::test {
namespace {

void add(TriangleSurface& surface, const TriangleSurface& other, const Eigen::Vector3d& shift, double scale) {
  const auto offset = static_cast<std::int32_t>(surface.vertices.size());
  for (const auto& x : other.vertices) {
    surface.vertices.emplace_back(scale * x + shift);
    surface.vertex_tags.push_back(static_cast<std::int64_t>(surface.vertices.size()));
  }
  for (const auto& t : other.triangles) {
    surface.triangles.push_back({t[0] + offset, t[1] + offset, t[2] + offset});
    surface.triangle_tags.push_back(static_cast<std::int64_t>(surface.triangles.size()));
  }
}

TriangleSurface turnedOver(TriangleSurface surface) {
  for (auto& t : surface.triangles) std::swap(t[1], t[2]);
  return surface;
}

TEST(CheckSurface, TakesACubeWhicheverWayItFaces) {
  EXPECT_NO_THROW(checkSurface(cube()));
  EXPECT_NO_THROW(checkSurface(turnedOver(cube())));
  EXPECT_NEAR(enclosedVolume(cube()), 1, 1e-15);
  EXPECT_NEAR(enclosedVolume(turnedOver(cube())), -1, 1e-15);
  EXPECT_NEAR(areaOf(cube()), 6, 1e-15);
}

TEST(CheckSurface, RefusesAHoleByItsPlace) {
  TriangleSurface surface = cube();
  surface.triangles.pop_back();
  EXPECT_REFUSED(checkSurface(surface), "1 hole: the surface is not closed",
                 "at (1 0.6667 0.6667) m (triangle");
}

TEST(CheckSurface, CountsHoles) {
  TriangleSurface surface = cube();
  surface.triangles.pop_back();
  surface.triangles.erase(surface.triangles.begin());
  EXPECT_REFUSED(checkSurface(surface), "2 holes");
}

TEST(CheckSurface, RefusesAnEdgeOfThreeTriangles) {
  TriangleSurface surface = cube();
  surface.vertices.emplace_back(5, 5, 5);
  surface.vertex_tags.push_back(9);
  surface.triangles.push_back({0, 1, 8});
  surface.triangle_tags.push_back(13);
  EXPECT_REFUSED(checkSurface(surface), "1 edge lies in more than two triangles, at (0.5 0 0) m (triangles");
}

TEST(CheckSurface, RefusesOneTriangleTurnedOver) {
  TriangleSurface surface = cube();
  std::swap(surface.triangles[4][1], surface.triangles[4][2]);
  EXPECT_REFUSED(checkSurface(surface), "3 edges are passed in the same direction by both",
                 "(triangles 5 and 6)");
}

TEST(CheckSurface, RefusesTrianglesWithoutArea) {
  TriangleSurface surface = cube();
  surface.vertices[7] = surface.vertices[6];
  EXPECT_REFUSED(checkSurface(surface), "2 triangles have no area", "triangle 8");
}

TEST(CheckSurface, RefusesNonFiniteVertex) {
  TriangleSurface surface = cube();
  surface.vertices[7].z() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_REFUSED(checkSurface(surface), "3 triangles have coordinates that are not finite", "triangle 4");
}

TEST(CheckSurface, RefusesATriangleThatIsThereTwice) {
  TriangleSurface surface = cube();
  surface.triangles.push_back({1, 0, 2});
  surface.triangle_tags.push_back(13);
  EXPECT_REFUSED(checkSurface(surface), "1 triangle is there twice", "(triangles 1 and 13)");
}

TEST(CheckSurface, ListsAllDefectsAtOnceWithThePlacesOfTheFirstThree) {
  TriangleSurface surface = cube();
  for (int i = 1; i < 6; ++i) add(surface, cube(), {5.0 * i, 0, 0}, 1);
  for (std::size_t i = 0; i < 5; ++i)
    std::swap(surface.triangles[12 * i + 4][1], surface.triangles[12 * i + 4][2]);
  surface.vertices.back() = {25.3, 0.4, -0.5};
  surface.triangles.push_back({0, 2, 1});
  surface.triangle_tags.push_back(99);
  EXPECT_REFUSED(checkSurface(surface), "15 edges are passed", ", ...; ", "pairs of triangles intersect",
                 "1 triangle is there twice");
}

TEST(CheckSurface, RefusesTwoConesJoinedAtTheirTips) {
  TriangleSurface surface = cube();
  add(surface, cube(), {1, 1, 1}, 1);
  for (auto& t : surface.triangles) {
    for (auto& v : t) v = v == 8 ? 7 : v;  // the second cube's first corner is the first one's last
  }
  EXPECT_REFUSED(checkSurface(surface),
                 "1 vertex joins several fans of triangles, at (1 1 1) m (triangles 4 and 13)");
}

TEST(CheckSurface, ListsAllVerticesOfSeveralFansBesideOtherDefects) {
  TriangleSurface surface = cube();
  for (int i = 1; i < 6; ++i) add(surface, cube(), {1.0 * i, 1.0 * i, 1.0 * i}, 1);
  for (auto& t : surface.triangles)  // each cube's first corner is the last of the one before
    for (auto& v : t) v = v % 8 == 0 && v > 0 ? v - 1 : v;
  EXPECT_REFUSED(checkSurface(surface), "5 vertices join several fans of triangles, at (1 1 1) m",
                 ", (2 2 2) m", "(3 3 3) m", ", ...");
  surface.triangles.pop_back();
  EXPECT_REFUSED(checkSurface(surface), "1 hole", "5 vertices join several fans of triangles");
}

TEST(CheckSurface, AHoleATwinAndAFlatTriangleMakeNoFans) {
  TriangleSurface surface = cube();
  surface.triangles.pop_back();
  surface.triangles.push_back(surface.triangles.front());
  surface.vertices[7] = surface.vertices[6];
  surface.triangle_tags.push_back(13);
  const auto defects = surfaceDefects(surface);
  EXPECT_GE(defects.size(), 3U);
  EXPECT_EQ(inWords(defects).find("fans"), std::string::npos) << inWords(defects);
}

TEST(CheckSurface, RefusesACornerPushedThroughTheOppositeFace) {
  TriangleSurface surface = cube();
  surface.vertices[7] = {0.3, 0.4, -0.5};
  EXPECT_REFUSED(checkSurface(surface), "cuts itself", "triangle", "intersect");
}

TEST(Solids, OneCubeKeepsItsOrderAndIsTurnedOutward) {
  const auto solids = solidsOf(turnedOver(cube()));
  ASSERT_EQ(solids.size(), 1U);
  EXPECT_NEAR(solids[0].volume, 1, 1e-15);
  EXPECT_EQ(solids[0].surface.triangles, cube().triangles);
  EXPECT_EQ(solids[0].surface.vertices, cube().vertices);
  EXPECT_TRUE(solids[0].cavities.empty());
}

TEST(Solids, TwoCubesAreTwoTheLargestFirst) {
  TriangleSurface surface = cube();
  add(surface, cube(), {5, 0, 0}, 2);
  const auto solids = solidsOf(surface);
  ASSERT_EQ(solids.size(), 2U);
  EXPECT_NEAR(solids[0].volume, 8, 1e-12);
  EXPECT_NEAR((solids[0].middle - Eigen::Vector3d(6, 1, 1)).norm(), 0, 1e-12);
  EXPECT_NEAR(solids[1].volume, 1, 1e-12);
  EXPECT_EQ(solids[1].surface.vertices.size(), 8U);
}

// Whether its triangles face outward or inward in the file. A cube in the cavity is a body of its own.
TEST(Solids, ACubeInsideIsACavity) {
  for (const bool inward : {false, true}) {
    TriangleSurface surface = cube();
    add(surface, inward ? turnedOver(cube()) : cube(), {0.2, 0.2, 0.2}, 0.5);
    add(surface, cube(), {0.3, 0.3, 0.3}, 0.1);
    const auto solids = solidsOf(surface);
    ASSERT_EQ(solids.size(), 2U);
    EXPECT_NEAR(solids[0].volume, 1 - 0.125, 1e-12);
    ASSERT_EQ(solids[0].cavities.size(), 1U);
    EXPECT_NEAR(solids[0].cavities[0].volume, 0.125, 1e-12);
    EXPECT_NEAR((solids[0].cavities[0].middle - Eigen::Vector3d(0.45, 0.45, 0.45)).norm(), 0, 1e-12);
    EXPECT_NEAR(enclosedVolume(solids[0].surface), 1 - 0.125, 1e-12);
    EXPECT_NEAR(solids[1].volume, 0.001, 1e-12);
  }
}

TEST(SelfIntersection, NamesTheTwoTriangles) {
  TriangleSurface surface;
  surface.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.2, 0.2, -1}, {0.2, 0.2, 1}, {2, 2, 0}};
  surface.triangles = {{0, 1, 2}, {3, 4, 5}};
  using Pairs = std::vector<std::pair<std::size_t, std::size_t>>;
  EXPECT_EQ(selfIntersections(surface), (Pairs{{0, 1}}));
}

TEST(SelfIntersection, FindsTrianglesFoldedOntoTheirNeighbour) {
  TriangleSurface surface;
  surface.vertices = {{0, 0, 0}, {1, 0, 0}, {0.5, 1, 0}, {0.5, 0.5, 0}};
  surface.triangles = {{0, 1, 2}, {1, 0, 3}};
  EXPECT_FALSE(selfIntersections(surface).empty());
  surface.vertices[3] = {0.5, -0.5, 0};  // unfolded
  EXPECT_TRUE(selfIntersections(surface).empty());
  surface.vertices[3] = {0.5, 0.5, 0.1};  // half open
  EXPECT_TRUE(selfIntersections(surface).empty());
}

TEST(SelfIntersection, FindsNeighboursAtACornerThatCross) {
  TriangleSurface surface;
  surface.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, -0.1}, {1, 1, 0.1}};
  surface.triangles = {{0, 1, 2}, {0, 3, 4}};
  EXPECT_FALSE(selfIntersections(surface).empty());
  surface.vertices[3] = {1, 1, 0.05};
  EXPECT_TRUE(selfIntersections(surface).empty());
}

TEST(SegmentMeetsTriangle, AlsoInItsPlane) {
  const TrianglePoints triangle{Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(0, 1, 0)};
  EXPECT_TRUE(segmentMeetsTriangle({-1, 0.2, 0}, {2, 0.2, 0}, triangle, 1e-9));
  EXPECT_FALSE(segmentMeetsTriangle({-1, 1.2, 0}, {2, 1.2, 0}, triangle, 1e-9));
  EXPECT_FALSE(segmentMeetsTriangle({0.2, 0.2, 0.1}, {0.2, 0.2, 1}, triangle, 1e-9));
  EXPECT_TRUE(segmentMeetsTriangle({0.2, 0.2, -1}, {0.2, 0.2, 1}, triangle, 1e-9));
}

// Each triangle of a fan crosses each of another that lies across it.
TEST(SelfIntersections, AreSoughtUpToANumber) {
  TriangleSurface surface;
  for (const bool across : {false, true})
    for (int i = 0; i < 40; ++i) {
      const double at = 0.01 * i;
      const auto first = static_cast<std::int32_t>(surface.vertices.size());
      for (const Eigen::Vector3d& x :
           {Eigen::Vector3d(-1, at, -1), Eigen::Vector3d(2, at, -1), Eigen::Vector3d(0.5, at, 3)})
        surface.vertices.push_back(across ? Eigen::Vector3d(x.y(), x.x(), x.z()) : x);
      surface.triangles.push_back({first, first + 1, first + 2});
    }
  EXPECT_EQ(selfIntersections(surface).size(), 1600U);
  const auto some = selfIntersections(surface, 100);
  EXPECT_GE(some.size(), 100U);
  EXPECT_LE(some.size(), 140U);
}

}  // namespace
}  // namespace palpate::mesh::test
