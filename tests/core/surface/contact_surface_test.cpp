// SPDX-License-Identifier: Apache-2.0
// The rounded surface that tools slide on.
#include "core/surface/contact_surface.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <random>
#include <utility>
#include <vector>

#include "../round_organ.h"

namespace palpate::testing {

TEST(ContactSurface, PointsGoToTheRestSurfaceAndBack) {
  const ContactSurface& surface = roundOrgan().contactSurface();
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  for (int trial = 0; trial < 500; ++trial) {
    const double a = uniform(random), b = uniform(random) * (1.0 - a);
    const ContactPoint s{
        static_cast<std::int32_t>(random() % static_cast<unsigned>(roundOrgan().surface().triangles())),
        {1.0 - a - b, a, b}};
    const ContactPoint back = surface.rest(surface.fine(s));
    EXPECT_EQ(back.triangle, s.triangle);
    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(back.barycentric[k], s.barycentric[k], 1e-12);
  }
}

TEST(ContactSurface, IsRounderThanTheTriangles) {
  const SurfaceMesh& fine = roundOrgan().contactSurface().mesh();
  double flat = 0.0, rounded = 0.0;
  for (int t = 0; t < roundOrgan().surface().triangles(); ++t) {
    const ContactPoint middle{t, {1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0}};
    flat = std::max(flat, std::abs(roundOrgan().surface().position(middle).norm() - 0.05));
    rounded =
        std::max(rounded, std::abs(fine.position(roundOrgan().contactSurface().fine(middle)).norm() - 0.05));
  }
  EXPECT_LT(rounded, 0.1 * flat);
}

TEST(Projection, FindsThePointThatTheTipLiesStraightAbove) {
  const SurfaceMesh& fine = roundOrgan().contactSurface().mesh();
  for (double angle = 0.0; angle < 2.0; angle += 0.013) {
    const Vec3 c = over(angle, 0.001);
    ContactPoint s = fine.closestPoint(c).s;
    double h = 0.0;
    ASSERT_TRUE(fine.project(c, s, h)) << angle;
    EXPECT_LT((fine.position(s) + h * fine.normal(s) - c).norm(), 1e-9);
  }
}

namespace {

/// A ball of 8 n^2 triangles: the octahedron's faces divided into n^2 each, laid on the sphere.
struct Ball {
  explicit Ball(int n) {
    const auto node = [&](int x, int y, int z) {
      const auto [at, is_new] =
          numbers.try_emplace({x, y, z}, static_cast<std::int32_t>(positions.size() / 3));
      const Vec3 X = 0.05 * Vec3(x, y, z).normalized();
      if (is_new) positions.insert(positions.end(), {X.x(), X.y(), X.z()});
      return at->second;
    };
    for (const int sx : {1, -1})
      for (const int sy : {1, -1})
        for (const int sz : {1, -1}) {
          const auto add = [&](std::array<int, 2> a, std::array<int, 2> b, std::array<int, 2> c) {
            if (sx * sy * sz < 0) std::swap(b, c);
            for (const auto& p : {a, b, c})
              triangles.push_back(node(sx * p[0], sy * p[1], sz * (n - p[0] - p[1])));
          };
          for (int i = 0; i < n; ++i)
            for (int j = 0; i + j < n; ++j) {
              add({i, j}, {i + 1, j}, {i, j + 1});
              if (i + j + 1 < n) add({i + 1, j}, {i + 1, j + 1}, {i, j + 1});
            }
        }
    position_of_node.resize(positions.size() / 3);
    std::iota(position_of_node.begin(), position_of_node.end(), 0);
    accessible.assign(position_of_node.size(), 1);
    view.surface_positions = positions;
    view.surface_triangles = view.contact_triangles = triangles;
    view.position_of_node = position_of_node;
    view.contact_accessible = accessible;
  }
  std::map<std::array<int, 3>, std::int32_t> numbers;
  std::vector<double> positions;
  std::vector<std::int32_t> triangles, position_of_node;
  std::vector<std::uint8_t> accessible;
  ModelView view;
};

/// Distance of the triangles' middles from the sphere, m: flat, and rounded.
std::array<double, 2> offTheSphere(const Ball& ball) {
  const SurfaceMesh rest(ball.view);
  const ContactSurface surface(ball.view, rest, kMostRoundedTriangles);
  std::array<double, 2> off{};
  for (std::int32_t t = 0; t < rest.triangles(); ++t)
    for (const auto& where :
         {ContactPoint{t, {1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0}}, ContactPoint{t, {0.5, 0.5, 0.0}}}) {
      off[0] = std::max(off[0], std::abs(rest.position(where).norm() - 0.05));
      off[1] = std::max(off[1], std::abs(surface.mesh().position(surface.fine(where)).norm() - 0.05));
    }
  return off;
}

}  // namespace

TEST(ContactSurface, IsRoundedAtAnySize) {
  for (const int n : {10, 100}) {  // 402 and 40,002 nodes
    const auto [flat, rounded] = offTheSphere(Ball(n));
    EXPECT_LT(rounded, 0.4 * flat) << n;
  }
}

TEST(ContactSurface, HasAtMostTheTrianglesAskedForButOneLevel) {
  const Ball ball(10);  // 800 triangles
  const SurfaceMesh rest(ball.view);
  for (const auto& [most, levels] :
       {std::pair<std::size_t, int>{300'000, 4}, {204'800, 4}, {204'799, 3}, {75'000, 3}, {1, 1}}) {
    const ContactSurface surface(ball.view, rest, most);
    EXPECT_EQ(surface.levels(), levels) << most;
    EXPECT_EQ(surface.mesh().triangles(), 800 << (2 * levels)) << most;
  }
}

}  // namespace palpate::testing
