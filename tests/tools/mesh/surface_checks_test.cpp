// SPDX-License-Identifier: Apache-2.0
#include <limits>

#include "helpers.h"
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

TEST(CheckSurface, TakesACube) {
  TriangleSurface surface = cube();
  EXPECT_NO_THROW(checkSurface(surface));
}

TEST(CheckSurface, TurnsAnInwardSurfaceOver) {
  TriangleSurface surface = cube();
  for (auto& t : surface.triangles) std::swap(t[1], t[2]);
  const auto inward = surface.triangles;
  checkSurface(surface);
  EXPECT_NE(surface.triangles, inward);
}

TEST(CheckSurface, RefusesAHole) {
  TriangleSurface surface = cube();
  surface.triangles.pop_back();
  EXPECT_REFUSED(checkSurface(surface), "not closed", "1 triangle instead of 2", "triangle 11");
}

TEST(CheckSurface, RefusesAnEdgeOfThreeTriangles) {
  TriangleSurface surface = cube();
  surface.vertices.emplace_back(5, 5, 5);
  surface.vertex_tags.push_back(9);
  surface.triangles.push_back({0, 1, 8});
  surface.triangle_tags.push_back(13);
  EXPECT_REFUSED(checkSurface(surface), "vertex 1 and vertex 2", "3 triangles");
}

TEST(CheckSurface, RefusesOneTriangleTurnedOver) {
  TriangleSurface surface = cube();
  std::swap(surface.triangles[4][1], surface.triangles[4][2]);
  EXPECT_REFUSED(checkSurface(surface), "same direction", "triangle 5");
}

TEST(CheckSurface, RefusesATriangleWithoutArea) {
  TriangleSurface surface = cube();
  surface.vertices[7] = surface.vertices[6];
  EXPECT_REFUSED(checkSurface(surface), "triangle 4", "has no area");
}

TEST(CheckSurface, RefusesNonFiniteVertex) {
  TriangleSurface surface = cube();
  surface.vertices[7].z() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_REFUSED(checkSurface(surface), "triangle 4", "not finite");
}

TEST(CheckSurface, RefusesTwoParts) {
  TriangleSurface surface = cube();
  add(surface, cube(), {5, 0, 0}, 1);
  EXPECT_REFUSED(checkSurface(surface), "disconnected", "triangle 13");
}

TEST(CheckSurface, RefusesTwoConesJoinedAtTheirTips) {
  TriangleSurface surface = cube();
  add(surface, cube(), {1, 1, 1}, 1);
  for (auto& t : surface.triangles) {
    for (auto& v : t) v = v == 8 ? 7 : v;  // the second cube's first corner is the first one's last
  }
  EXPECT_REFUSED(checkSurface(surface), "vertex 8 joins several fans");
}

TEST(CheckSurface, RefusesACornerPushedThroughTheOppositeFace) {
  TriangleSurface surface = cube();
  surface.vertices[7] = {0.3, 0.4, -0.5};
  EXPECT_REFUSED(checkSurface(surface), "cuts itself", "triangle", "intersect");
}

TEST(SelfIntersection, NamesTheTwoTriangles) {
  TriangleSurface surface;
  surface.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.2, 0.2, -1}, {0.2, 0.2, 1}, {2, 2, 0}};
  surface.triangles = {{0, 1, 2}, {3, 4, 5}};
  const auto pair = firstSelfIntersection(surface);
  ASSERT_TRUE(pair.has_value());
  EXPECT_EQ(*pair, (std::pair<std::size_t, std::size_t>(0, 1)));
}

TEST(SelfIntersection, FindsTrianglesFoldedOntoTheirNeighbour) {
  TriangleSurface surface;
  surface.vertices = {{0, 0, 0}, {1, 0, 0}, {0.5, 1, 0}, {0.5, 0.5, 0}};
  surface.triangles = {{0, 1, 2}, {1, 0, 3}};
  EXPECT_TRUE(firstSelfIntersection(surface).has_value());
  surface.vertices[3] = {0.5, -0.5, 0};  // unfolded
  EXPECT_FALSE(firstSelfIntersection(surface).has_value());
  surface.vertices[3] = {0.5, 0.5, 0.1};  // half open
  EXPECT_FALSE(firstSelfIntersection(surface).has_value());
}

TEST(SelfIntersection, FindsNeighboursAtACornerThatCross) {
  TriangleSurface surface;
  surface.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, -0.1}, {1, 1, 0.1}};
  surface.triangles = {{0, 1, 2}, {0, 3, 4}};
  EXPECT_TRUE(firstSelfIntersection(surface).has_value());
  surface.vertices[3] = {1, 1, 0.05};
  EXPECT_FALSE(firstSelfIntersection(surface).has_value());
}

TEST(SegmentMeetsTriangle, AlsoInItsPlane) {
  const TrianglePoints triangle{Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(0, 1, 0)};
  EXPECT_TRUE(segmentMeetsTriangle({-1, 0.2, 0}, {2, 0.2, 0}, triangle, 1e-9));
  EXPECT_FALSE(segmentMeetsTriangle({-1, 1.2, 0}, {2, 1.2, 0}, triangle, 1e-9));
  EXPECT_FALSE(segmentMeetsTriangle({0.2, 0.2, 0.1}, {0.2, 0.2, 1}, triangle, 1e-9));
  EXPECT_TRUE(segmentMeetsTriangle({0.2, 0.2, -1}, {0.2, 0.2, 1}, triangle, 1e-9));
}

}  // namespace
}  // namespace palpate::mesh::test
