// SPDX-License-Identifier: Apache-2.0
// How far the series goes, against Newton.
#include <gtest/gtest.h>

#include <array>

#include "block_series.h"

namespace palpate::solver {
namespace {

TEST_F(BlockSeries, ForceErrorInsideTheDomainIsSmall) {
  Case c(box_, 160e3);
  SeriesSolver series(c.model, c.factor, 3);
  series.solve(c.patches);
  const std::vector<SeriesRadii> radii = series.domainRadii({});
  ASSERT_EQ(radii.size(), 3U);
  NewtonSolver newton(c.model);
  for (int lane = 0; lane < 3; ++lane) {
    const double radius = radii[static_cast<std::size_t>(lane)].domain;
    EXPECT_GT(radius, 1e-3);
    EXPECT_LT(radius, 0.05);
    const Vec3 d = radius * Vec3(-0.6, 0.0, -0.8);
    const NewtonResult truth = newton.solvePatch(c.patches[static_cast<std::size_t>(lane)], d, {});
    EXPECT_LT((force(series, lane, d) - truth.force).norm(), 0.01 * truth.force.norm());
    EXPECT_GE(c.model.minDetF(truth.u), 0.25);
  }
}

TEST_F(BlockSeries, FieldsErrByWhatTheirDomainAllowsAtItsRim) {
  Case c(box_, 160e3);
  DomainCriteria field_only;
  field_only.answer_error = 1e9;
  field_only.min_det_f = -1e9;
  NewtonSolver newton(c.model);
  for (const int order : {3, 5}) {
    SeriesSolver series(c.model, c.factor, order);
    series.solve(c.patches);
    const std::vector<SeriesRadii> radii = series.domainRadii(field_only);
    for (int lane = 0; lane < 3; ++lane) {
      const double radius = radii[static_cast<std::size_t>(lane)].domain;
      double worst = 0.0;
      for (const Vec3& direction : {Vec3(0, 0, -1), Vec3(0, 0, 1), Vec3(1, 0, 0), Vec3(0, -1, 0),
                                    Vec3(-1, 0, 0), Vec3(0.6, 0, -0.8), Vec3(0, 1, 0)}) {
        const Vec3 d = radius * direction;
        const NewtonResult truth = newton.solvePatch(c.patches[static_cast<std::size_t>(lane)], d, {});
        worst = std::max(worst, (field(series, lane, d, c.model) - truth.u)
                                    .reshaped(3, c.model.nodeCount())
                                    .colwise()
                                    .norm()
                                    .maxCoeff());
      }
      EXPECT_LT(worst, 0.04 * radius) << "order " << order << ", lane " << lane;
      if (order == 3) {
        EXPECT_GT(worst, 0.003 * radius) << "lane " << lane;
      }
    }
  }
}

TEST_F(BlockSeries, HigherOrdersReachFurther) {
  Case c(box_, 160e3);
  DomainCriteria strict;
  strict.field_error = 1e-3;
  std::array<double, 3> reached{};
  for (const int order : {1, 2, 3, 5}) {
    SeriesSolver series(c.model, c.factor, order);
    series.solve(c.patches);
    const std::vector<SeriesRadii> radii = series.domainRadii(strict);
    for (std::size_t lane = 0; lane < 3; ++lane) {
      EXPECT_GT(radii[lane].domain, 1.2 * reached[lane]) << "order " << order << ", lane " << lane;
      reached[lane] = radii[lane].domain;
    }
  }
}

TEST_F(BlockSeries, DomainShrinksAsTheLimitOnDetFRises) {
  Case c(box_, 160e3);
  SeriesSolver series(c.model, c.factor, 3);
  series.solve(c.patches);
  DomainCriteria loose;
  loose.answer_error = loose.field_error = 1e9;
  DomainCriteria tight = loose;
  tight.min_det_f = 0.9;
  const double wide = series.domainRadii(loose)[0].domain;
  const double narrow = series.domainRadii(tight)[0].domain;
  EXPECT_LT(narrow, 0.7 * wide);
  double worst = 1.0;
  for (const Vec3& direction : {Vec3(0, 0, -1), Vec3(0, 0, 1), Vec3(1, 0, 0), Vec3(-1, 0, 0)})
    worst = std::min(worst, c.model.minDetF(field(series, 0, narrow * direction, c.model)));
  EXPECT_GE(worst, 0.9 - 1e-6);
}

TEST_F(BlockSeries, PatchGoesWhereTheForceSeriesSaysInsideItsDomain) {
  Case c(box_, 160e3);
  SeriesSolver series(c.model, c.factor, 3, SeriesKind::kForce);
  series.solve(c.patches);
  const std::vector<SeriesRadii> radii = series.domainRadii({});
  for (int lane = 0; lane < 3; ++lane) {
    const Patch& patch = c.patches[static_cast<std::size_t>(lane)];
    EXPECT_GT(radii[static_cast<std::size_t>(lane)].domain, 0.01);
    const Vec3 f = radii[static_cast<std::size_t>(lane)].domain * Vec3(-0.6, 0.0, -0.8);
    Eigen::VectorXd load = Eigen::VectorXd::Zero(3 * c.model.nodeCount());
    patch.addForce(f, load);
    const NewtonResult truth = NewtonSolver(c.model).solveLoad(load, {});
    const Vec3 d = patch.average(truth.u);
    const Vec3 kept = sum(series.basis(), f, [&](int k) { return series.answer(lane, k); });
    EXPECT_LT((kept - d).norm(), 0.012 * d.norm());
    EXPECT_GE(c.model.minDetF(truth.u), 0.25);
  }
}

}  // namespace
}  // namespace palpate::solver
