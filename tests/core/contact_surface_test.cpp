// SPDX-License-Identifier: Apache-2.0
// The rounded surface that tools slide on.
#include "palpate/core/contact_surface.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "round_organ.h"

namespace palpate::testing {

namespace {

const MetaModel& organ() {
  return roundOrgan();
}

}  // namespace

TEST(ContactSurface, PointsGoToTheRestSurfaceAndBack) {
  const ContactSurface& surface = organ().contactSurface();
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  for (int trial = 0; trial < 500; ++trial) {
    const double a = uniform(random), b = uniform(random) * (1.0 - a);
    const ContactPoint s{
        static_cast<std::int32_t>(random() % static_cast<unsigned>(organ().surface().triangles())),
        {1.0 - a - b, a, b}};
    const ContactPoint back = surface.rest(surface.fine(s));
    EXPECT_EQ(back.triangle, s.triangle);
    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(back.barycentric[k], s.barycentric[k], 1e-12);
  }
}

TEST(ContactSurface, IsRounderThanTheTriangles) {
  const SurfaceMesh& fine = organ().contactSurface().mesh();
  double flat = 0.0, rounded = 0.0;
  for (int t = 0; t < organ().surface().triangles(); ++t) {
    const ContactPoint middle{t, {1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0}};
    flat = std::max(flat, std::abs(organ().surface().position(middle).norm() - 0.05));
    rounded = std::max(rounded, std::abs(fine.position(organ().contactSurface().fine(middle)).norm() - 0.05));
  }
  EXPECT_LT(rounded, 0.1 * flat);
}

TEST(Projection, FindsThePointThatTheTipLiesStraightAbove) {
  const SurfaceMesh& fine = organ().contactSurface().mesh();
  for (double angle = 0.0; angle < 2.0; angle += 0.013) {
    const Vec3 c = over(angle, 0.001);
    ContactPoint s = fine.closestPoint(c).s;
    double h = 0.0;
    ASSERT_TRUE(fine.project(c, s, h)) << angle;
    EXPECT_LT((fine.position(s) + h * fine.normal(s) - c).norm(), 1e-9);
  }
}

}  // namespace palpate::testing
