// SPDX-License-Identifier: Apache-2.0
#include "core/response/largest_stiffness.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <random>

#include "../load_driven.h"
#include "core/response/patch_response.h"

namespace palpate::testing {

namespace {

double largestEigenvalue(const Mat3& K) {
  return Eigen::SelfAdjointEigenSolver<Mat3>(0.5 * (K + K.transpose())).eigenvalues().maxCoeff();
}

/// Braces, because compilers differ in the order in which they evaluate arguments.
Vec3 draw(std::mt19937& random) {
  std::normal_distribution<double> normal;
  return Vec3{normal(random), normal(random), normal(random)};
}

/// Of random inward touches within the domain, half of them up to its end, between positions too.
double largestOfTouches(const MetaModel& model, int touches) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> share(0.0, 1.0);
  double most = 0.0;
  for (int i = 0; i < touches; ++i) {
    Vec3 X = draw(random).normalized();
    X.z() = std::abs(X.z());
    const ContactPoint s = model.surface().closestPoint(X).s;
    Vec3 d = draw(random).normalized();
    d -= std::max(0.0, 2.0 * d.dot(X)) * X;
    Response out;
    const double radius = model.response().domainRadius(model.surface().mix(s));
    if (respond(model, s, (i % 2 == 0 ? 1.0 : share(random)) * radius * d, out) == ResponseStatus::kOk)
      most = std::max(most, largestEigenvalue(out.stiffness));
  }
  return most;
}

}  // namespace

TEST(LargestStiffness, OfALinearOrganIsThatOfItsStiffestPlaceAtRest) {
  EXPECT_NEAR(largestStiffness(loadSynthetic({.order = 1})), 450.0, 0.5) << "along the normal, everywhere";
  const double stiffest = largestStiffness(loadSynthetic({.order = 1, .contrast = 0.5}));
  EXPECT_GT(stiffest, 1.3 * 450.0);
  EXPECT_LE(stiffest, 1.5 * 450.5);
}

TEST(LargestStiffness, CoversWhatTouchesMeetWithinTheDomain) {
  for (const double nonlinearity : {0.1, 0.3}) {
    const MetaModel model = loadSynthetic({.nonlinearity = nonlinearity, .contrast = 0.3});
    const double found = largestStiffness(model), met = largestOfTouches(model, 2000);
    EXPECT_GT(found, 1.1 * 1.3 * 450.0) << "it stiffens under load";
    EXPECT_LE(met, 1.03 * found) << nonlinearity;
    EXPECT_GE(met, 0.8 * found) << nonlinearity;
  }
}

TEST(LargestStiffness, OfLoadDrivenModelsIsFoundByTheirLoads) {
  std::mt19937 random(7);
  double met = 0.0;
  for (int i = 0; i < 500; ++i) {
    Vec3 X = draw(random).normalized();
    X.z() = std::abs(X.z());
    Response out;
    const Vec3 f = draw(random).normalized() - X;
    if (respondToLoad(forceModel(), forceModel().surface().closestPoint(X).s,
                      forceOptions().domain_force * f.normalized(), out) == ResponseStatus::kOk)
      met = std::max(met, largestEigenvalue(out.stiffness));
  }
  const double found = largestStiffness(forceModel());
  EXPECT_LE(met, 1.05 * found);
  EXPECT_GE(met, 0.85 * found);
  const MetaModel level = loadSynthetic({.subdivisions = 2, .parameters = Parameters::kLevel});
  EXPECT_GT(largestStiffness(level), 50.0);
  EXPECT_LT(largestStiffness(level), 1e4);
}

}  // namespace palpate::testing
