// SPDX-License-Identifier: Apache-2.0
// A displacement that is longer than the model promises, and one beyond the end of its polynomials.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>

#include "core/response/tool_coupling.h"
#include "random_touch.h"

namespace palpate::testing {

TEST(Response, StiffnessIsTheDerivativeOfForceInsideAndBeyondTheDomain) {
  RandomTouch random;
  for (const double size : {0.004, 0.02}) {
    for (int trial = 0; trial < 50; ++trial) {
      const ContactPoint s = random.contactPoint();
      const Vec3 d = random.vector(size);
      Response here, plus, minus;
      const ResponseStatus status = respond(touchedOrgan(), s, d, here);
      if (std::abs(d.norm() - here.series_radius) < 1e-6) continue;  // the kink
      EXPECT_EQ(status, d.norm() > here.domain_radius ? ResponseStatus::kBeyond : ResponseStatus::kOk);
      const double h = 1e-7;
      for (Eigen::Index j = 0; j < 3; ++j) {
        (void)respond(touchedOrgan(), s, d + h * Vec3::Unit(j), plus);
        (void)respond(touchedOrgan(), s, d - h * Vec3::Unit(j), minus);
        EXPECT_LT((here.stiffness.col(j) - (plus.force - minus.force) / (2.0 * h)).norm(), 1e-3);
      }
      if (d.norm() < here.series_radius) {
        EXPECT_LT((here.stiffness - here.stiffness.transpose()).norm(), 1e-9);
      }
    }
  }
}

TEST(Response, BetweenTheDomainAndTheEndOfThePolynomialsTheyRunOnFlagged) {
  RandomTouch random;
  for (int trial = 0; trial < 20; ++trial) {
    const ContactPoint s = random.contactPoint();
    const Vec3 direction = random.vector(1.0).normalized();
    Response out;
    EXPECT_EQ(respond(touchedOrgan(), s, 0.999 * options().domain_radius * direction, out),
              ResponseStatus::kOk);
    const Vec3 d = 0.5 * (options().domain_radius + options().series_radius) * direction;
    EXPECT_EQ(respond(touchedOrgan(), s, d, out), ResponseStatus::kBeyond);
    EXPECT_NEAR(out.domain_radius, options().domain_radius, 1e-15);
    EXPECT_NEAR(out.series_radius, options().series_radius, 1e-15);
    EXPECT_EQ(out.displacement, d);
    EXPECT_EQ(out.parameter, d);
    const PatchResponse patch(touchedOrgan(), s);
    const double h = 1e-7;
    for (int j = 0; j < 3; ++j)
      EXPECT_NEAR((patch.energy(d + h * Vec3::Unit(j)) - patch.energy(d - h * Vec3::Unit(j))) / (2.0 * h),
                  out.force[j], 1e-6 * out.force.norm());
  }
}

TEST(Response, WhereThePolynomialsEndTheForceGoesOnAlongTheStiffnessThatPushesBack) {
  RandomTouch random;
  const ContactPoint s = random.contactPoint();
  const Vec3 d(0.003, 0.02, -0.01);
  const Vec3 on_edge = d.normalized() * options().series_radius;
  Response far, edge;
  EXPECT_EQ(respond(touchedOrgan(), s, d, far), ResponseStatus::kBeyond);
  (void)respond(touchedOrgan(), s, on_edge * (1.0 - 1e-12), edge);
  EXPECT_NEAR(far.displacement.norm(), kShownRadii * options().series_radius, 1e-15);
  const Eigen::SelfAdjointEigenSolver<Mat3> eigen(edge.stiffness);
  const Mat3& V = eigen.eigenvectors();
  const Mat3 positive = V * eigen.eigenvalues().cwiseMax(0.0).asDiagonal() * V.transpose();
  EXPECT_LT((far.force - edge.force - positive * (d - on_edge)).norm(), 1e-8 * far.force.norm());
  EXPECT_LT(largestDifference(field(s, d), field(s, far.displacement)), 1e-9);
}

TEST(Response, BeyondItsPolynomialsTheFieldIsExtrapolatedLinearlyAndThenStays) {
  RandomTouch random;
  for (int sample = 0; sample < 10; ++sample) {
    const ContactPoint s = random.contactPoint();
    const Vec3 direction = random.vector(1.0).normalized();
    Response here;
    (void)respond(touchedOrgan(), s, direction, here);
    const Vec3 edge = here.series_radius * direction;
    const double h = 1e-3;
    const std::vector<float> at_edge = field(s, edge), before = field(s, (1.0 - h) * edge),
                             beyond = field(s, 1.7 * edge), end = field(s, kShownRadii * edge);
    double largest = 0.0, bent = 0.0;
    for (std::size_t i = 0; i < at_edge.size(); ++i) {
      const double u = double{at_edge[i]}, slope = (u - double{before[i]}) / h;
      largest = std::max(largest, std::abs(double{beyond[i]} - u - 0.7 * slope));
      bent = std::max(bent, std::abs(double{beyond[i]} - 1.7 * u));
    }
    EXPECT_LT(largest, 0.01 * here.series_radius);  // of the difference: h and rounding
    EXPECT_GT(bent, 5.0 * largest);
    EXPECT_EQ(field(s, 3.0 * edge), end);
  }
}

/// Inside, extrapolated, and where a tool's own part goes on in proportion.
TEST(FieldGradients, AreTheDerivativeOfAToolsOwnPart) {
  RandomTouch random;
  const auto size = index(touchedOrgan().functions().size());
  std::vector<double> plus(size), minus(size);
  std::vector<Vec3> gradient(size);
  for (const double radii : {0.6, 1.5, 1.9, 2.6})
    for (int sample = 0; sample < 10; ++sample) {
      const ContactPoint s = random.contactPoint();
      const double limit = options().series_radius, h = 1e-6 * limit;
      const Vec3 d = radii * limit * random.vector(1.0).normalized();
      fieldGradients(touchedOrgan(), d, limit, gradient);
      double largest = 0.0;
      for (const Vec3& g : gradient) largest = std::max(largest, g.norm());
      const auto part = [&](const Vec3& at, std::vector<double>& phi) {
        const FieldSource own = ownPart(touchedOrgan(), s, at);
        fieldFunctions(touchedOrgan(), own.parameter, limit, phi);
        for (double& value : phi) value *= own.gain;
      };
      for (Eigen::Index i = 0; i < 3; ++i) {
        part(d + h * Vec3::Unit(i), plus);
        part(d - h * Vec3::Unit(i), minus);
        for (std::size_t k = 0; k < size; ++k)
          EXPECT_NEAR(gradient[k][i], (plus[k] - minus[k]) / (2.0 * h), 1e-7 * largest) << radii << ' ' << k;
      }
    }
}

TEST(Response, ForceHasNoCliffAtTheDomainAndItsStiffnessIsItsSlope) {
  RandomTouch random;
  for (int sample = 0; sample < 50; ++sample) {
    const ContactPoint s = random.contactPoint();
    const Vec3 direction = random.vector(1.0).normalized();
    Response last, now;
    (void)respond(touchedOrgan(), s, Vec3::Zero(), last);
    for (double size = 1e-5; size < 0.02; size += 1e-5) {
      (void)respond(touchedOrgan(), s, size * direction, now);
      ASSERT_LT((now.force - last.force).norm(),
                1e-5 * 2.0 * std::max(now.stiffness.norm(), last.stiffness.norm()));
      last = now;
    }
    const double h = 1e-7;
    for (int j = 0; j < 3; ++j) {
      Response plus, minus;
      (void)respond(touchedOrgan(), s, 0.012 * direction + h * Vec3::Unit(j), plus);
      (void)respond(touchedOrgan(), s, 0.012 * direction - h * Vec3::Unit(j), minus);
      Response here;
      (void)respond(touchedOrgan(), s, 0.012 * direction, here);
      EXPECT_LT((here.stiffness.col(j) - (plus.force - minus.force) / (2.0 * h)).norm(),
                1e-3 * here.stiffness.norm());
    }
  }
}

TEST(Response, AHugeDisplacementIsAnsweredWithANumber) {
  RandomTouch random;
  const ContactPoint s = random.contactPoint();
  for (const double size : {1.0, 1e10, 1e200}) {
    Response far;
    EXPECT_EQ(respond(touchedOrgan(), s, size * Vec3(1.0, 1.0, -1.0), far), ResponseStatus::kBeyond);
    EXPECT_TRUE(far.force.allFinite());
    EXPECT_TRUE(far.stiffness.allFinite());
    EXPECT_GT(far.force.dot(Vec3(1.0, 1.0, -1.0)), 0.0);
  }
}

}  // namespace palpate::testing
