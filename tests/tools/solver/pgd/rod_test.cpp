// SPDX-License-Identifier: Apache-2.0
#include "tools/solver/pgd/rod.h"

#include <gtest/gtest.h>

#include <cmath>

namespace palpate::solver {
namespace {

TEST(Rod, StretchIsTheRealRootOnBothSidesOfThePapersRadical) {
  for (const double K : {0.0, 0.01, 0.19, 1.0 / std::sqrt(27.0), 0.2, 3.0}) {
    const double l = exactStretch(K);
    EXPECT_NEAR(l * l * l - l, 2.0 * K, 1e-14 * (1.0 + 2.0 * K)) << K;
    EXPECT_GE(l, 1.0 - 1e-15) << K;
  }
}

TEST(Rod, TipOfThePapersRodMovesBy63Point88Millimetres) {
  EXPECT_NEAR(exactTip(RodData().loadNumber(), 0.4), 63.88194110594539e-3, 1e-15);
}

TEST(Rod, StretchNeedsALoadThatPulls) {
  EXPECT_THROW((void)exactStretch(-0.1), std::invalid_argument);
}

TEST(Rod, ExactSolutionIsInEquilibriumAtEveryPosition) {
  const RodProblem rod(RodData{});
  const Eigen::MatrixXd u = exactSolution(rod);
  const Eigen::MatrixXd loads = rod.loads();
  for (int s = 0; s < rod.positions(); ++s)
    EXPECT_LT((rod.internalForce(u.col(s)) - loads.col(s)).norm(), 1e-10) << s;
}

TEST(Rod, TangentIsDerivativeOfForce) {
  const RodProblem rod(RodData{.elements = 7});
  const Eigen::VectorXd u = 0.01 * Eigen::VectorXd::LinSpaced(7, 0.3, 4.0).array().sin().matrix();
  const Eigen::VectorXd v = Eigen::VectorXd::LinSpaced(7, 1.0, -2.0);
  SparseMatrix K = rod.stiffness();
  rod.tangent(u, K);
  const double h = 1e-6;
  const Eigen::VectorXd difference =
      (rod.internalForce(u + h * v) - rod.internalForce(u - h * v)) / (2.0 * h);
  EXPECT_LT((K * v - difference).norm(), 1e-8 * difference.norm());
}

TEST(Rod, WeightsAddUpToTheLengthBetweenTheFirstHalfElementAndTheTip) {
  const RodData data{.elements = 8};
  EXPECT_NEAR(RodProblem(data).weights().sum(), data.length * (1.0 - 0.5 / 8), 1e-15);
}

TEST(Rod, RefusesARodWithoutLengthOrElements) {
  EXPECT_THROW(RodProblem(RodData{.length = 0.0}), std::invalid_argument);
  EXPECT_THROW(RodProblem(RodData{.elements = 0}), std::invalid_argument);
}

TEST(RodSeries, DisplacementDrivenSeriesIsExactFromOrderThree) {
  const RodProblem rod(RodData{});
  const double exact = exactTip(rod.data().loadNumber(), rod.data().length);
  const auto error = [&](int order) {
    return std::abs(rodSeries(rod, 39, order).displacement(320.0) / exact - 1.0);
  };
  EXPECT_GT(error(1), 0.2);
  EXPECT_GT(error(2), 5e-3);
  EXPECT_LT(error(2), 0.1 * error(1));
  for (int order = 3; order <= 5; ++order) EXPECT_LE(error(order), 1e-12) << order;
}

TEST(RodSeries, ForceIsTheCubicOfOneUniformStrain) {
  const RodProblem rod(RodData{});
  const int node = 9;  // x = 100 mm
  const RodSeries series = rodSeries(rod, node, 5);
  const double EA = 1600.0, s = 0.1;
  EXPECT_NEAR(series.f[0], EA / s, 1e-9 * EA / s);
  EXPECT_NEAR(series.f[1], 1.5 * EA / (s * s), 1e-9 * EA / (s * s));
  EXPECT_NEAR(series.f[2], 0.5 * EA / (s * s * s), 1e-9 * EA / (s * s * s));
  EXPECT_LT(std::abs(series.f[3]), 1e-7 * EA / std::pow(s, 4));
  EXPECT_NEAR(series.U(4, 0), 0.5, 1e-12);
  EXPECT_NEAR(series.U(30, 0), 1.0, 1e-12);
  EXPECT_LT(series.U.rightCols(4).cwiseAbs().maxCoeff(), 1e-7 / s);
}

TEST(RodSeries, RefusesANodeThatIsNotThere) {
  const RodProblem rod(RodData{.elements = 4});
  EXPECT_THROW((void)rodSeries(rod, 4, 3), std::invalid_argument);
  EXPECT_THROW((void)rodSeries(rod, 3, 0), std::invalid_argument);
}

}  // namespace
}  // namespace palpate::solver
