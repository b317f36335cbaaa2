// SPDX-License-Identifier: Apache-2.0
#include "tools/solver/pgd/linear_pgd.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "../linear_problems.h"
#include "tools/solver/pgd/energy_error.h"
#include "tools/solver/pgd/load_separation.h"
#include "tools/solver/pgd/recompression.h"

namespace palpate::solver {
namespace {

using Eigen::MatrixXd;

LinearPgdOptions quiet(int pairs) {
  LinearPgdOptions options;
  options.max_pairs = pairs;
  options.tolerance = 0.0;
  options.quiet = true;
  return options;
}

LinearPgdOptions componentWise(int pairs) {
  LinearPgdOptions options = quiet(pairs);
  options.separation = Separation::kHadamard;
  return options;
}

/// One pair, iterated until it stands still.
LinearPgdOptions converged(LinearPgdOptions options) {
  options.block = 1;
  options.update = 0;
  options.max_sweeps = 2000;
  options.pair_tolerance = 0.0;
  return options;
}

class LinearPgd : public ::testing::Test {
 protected:
  const PalpatedBox box_;
  const BodyProblem problem_{box_.problem({-Vec3::UnitZ()})};

  double error(const SeparatedSolution& u) const { return energyError(problem_, u.scalarPairs(), 1); }
};

TEST_F(LinearPgd, ErrorFallsAsPairsAreAdded) {
  for (LinearPgdOptions options : {quiet(0), componentWise(0)}) {
    double before = 1.0;
    for (const int pairs : {2, 4, 8, 16}) {
      options.max_pairs = pairs;
      const double now = error(solveLinearPgd(problem_, options));
      EXPECT_LT(now, 0.8 * before) << pairs;
      before = now;
    }
  }
}

TEST_F(LinearPgd, SaysWhatTheTruncatedLoadLeavesOut) {
  EXPECT_EQ(solveLinearPgd(problem_, quiet(2)).load_error, 0.0);
  LinearPgdOptions options = quiet(2);
  options.load_terms = 5;
  const SeparatedLoad load(problem_.loads(), problem_.weights(), 5, options.seed);
  EXPECT_EQ(solveLinearPgd(problem_, options).load_error, load.truncationError());
  EXPECT_GT(load.truncationError(), 0.01);
}

TEST_F(LinearPgd, FirstPairIsTheStrongestSingularPair) {
  const SeparatedSolution u = solveLinearPgd(problem_, converged(quiet(3)));
  const Eigen::VectorXd sigma = energySingularValues(complianceMatrix(problem_, 1), problem_.weights());
  for (Eigen::Index n = 1; n <= 3; ++n) {
    SeparatedSolution first = u;
    first.X = u.X.leftCols(n);
    first.Y[0] = u.Y[0].topRows(n);
    EXPECT_NEAR(error(first), bestError(sigma, n), 1e-6) << n;
  }
}

TEST_F(LinearPgd, ResidualIsTheErrorWithinItsSpread) {
  for (const auto& options : {quiet(6), quiet(20), componentWise(6)}) {
    const SeparatedSolution u = solveLinearPgd(problem_, options);
    const EnrichmentStep& last = u.history.back();
    EXPECT_NEAR(last.residual, error(u), 0.1 * error(u));
    EXPECT_NEAR(last.residual, error(u), 2.0 * last.spread);
    EXPECT_LT(last.spread, 0.1 * last.residual);
  }
}

TEST_F(LinearPgd, StopsOnTheResidual) {
  LinearPgdOptions options = quiet(40);
  options.tolerance = 0.05;
  options.block = options.update = options.residual_every = 1;
  const SeparatedSolution u = solveLinearPgd(problem_, options);
  ASSERT_GE(u.history.size(), 2U);
  EXPECT_LE(u.history.back().residual, 0.05);
  EXPECT_GT((u.history.end() - 2)->residual, 0.05);
}

TEST_F(LinearPgd, AllPairsReproduceTheSolution) {
  for (const int update : {0, 8}) {
    LinearPgdOptions options = quiet(problem_.positions());
    options.update = update;
    EXPECT_LT(error(solveLinearPgd(problem_, options)), 1e-8) << update;
  }
  EXPECT_LT(error(solveLinearPgd(problem_, componentWise(problem_.positions()))), 1e-8);
}

TEST_F(LinearPgd, UpdatedYLeaveNoResidualOnTheModes) {
  for (const auto& options : {quiet(10), componentWise(10)}) {
    const SeparatedSolution u = solveLinearPgd(problem_, options);
    const MatrixXd X = byComponent(u.X, u.components, u.terms());
    const MatrixXd loads = X.transpose() * problem_.loads();
    const MatrixXd residual = loads - u.project(problem_.stiffness() * X);
    EXPECT_LT(residual.norm(), 1e-9 * loads.norm());
  }
}

// Stationarity of R o S in its S-step (every s, every component) and in its R-step (every unknown).
TEST_F(LinearPgd, ConvergedComponentWisePairLeavesNoResidualOnItself) {
  const SeparatedSolution u = solveLinearPgd(problem_, converged(componentWise(2)));
  const MatrixXd R = byComponent(u.X.rightCols(1), u.components, 3);
  const MatrixXd on_R = R.transpose() * problem_.loads();
  EXPECT_LT((on_R - u.project(problem_.stiffness() * R)).norm(), 1e-9 * on_R.norm());
  MatrixXd P(problem_.positions(), 3);
  for (Eigen::Index c = 0; c < 3; ++c)
    P.col(c) = problem_.weights().asDiagonal() * u.Y[static_cast<std::size_t>(c)].bottomRows(1).transpose();
  const MatrixXd on_S = problem_.loads() * P;
  const MatrixXd residual = on_S - problem_.stiffness() * u.times(P);
  double square = 0.0;
  for (Eigen::Index i = 0; i < residual.rows(); ++i) square += std::pow(residual(i, i % 3), 2);
  EXPECT_LT(std::sqrt(square), 1e-5 * on_S.norm());
}

// K R has forces along the load only, so the other components of the S-step are met by the same S.
TEST_F(LinearPgd, ComponentWisePairsAreScalarUnderALoadOfOneDirection) {
  LinearPgdOptions scalar = quiet(6);
  scalar.block = 1;
  EXPECT_NEAR(error(solveLinearPgd(problem_, componentWise(6))), error(solveLinearPgd(problem_, scalar)),
              1e-9);
}

TEST_F(LinearPgd, ComponentWisePairsHoldMoreUnderLoadsOfThreeDirections) {
  const BodyProblem problem = box_.problem({Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ()});
  const auto left = [&](LinearPgdOptions options) {
    options.max_sweeps = 50;
    options.block = 1;
    return energyError(problem, solveLinearPgd(problem, options).scalarPairs(), 1);
  };
  EXPECT_LT(left(componentWise(6)), 0.99 * left(quiet(6)));
}

TEST_F(LinearPgd, ThreeDirectionsGiveTheComplianceOfEveryPatch) {
  const std::vector<Vec3> axes{Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ()};
  const BodyProblem problem = box_.problem(axes);
  ASSERT_EQ(problem.positions(), 3 * problem_.positions());
  const SeparatedSolution u = solveLinearPgd(problem, quiet(problem.positions()));
  const MatrixXd exact = complianceMatrix(problem, 1);
  const MatrixXd C = u.project(problem.loads()).transpose();  // row s: l_t^T u_s
  EXPECT_LT((C - exact).norm(), 1e-7 * exact.norm());
  EXPECT_GT(exact(0, 0), 0.0);
}

TEST_F(LinearPgd, TruncatedLoadGivesTheSolutionOfTheTruncatedLoad) {
  double before = 1.0;
  for (const int terms : {5, 15, 30}) {
    LinearPgdOptions options = quiet(problem_.positions());
    options.load_terms = terms;
    const double now = error(solveLinearPgd(problem_, options));
    EXPECT_LT(now, before) << terms;
    EXPECT_GT(now, 1e-4) << terms;
    before = now;
  }
}

TEST(LinearPgdOfARod, OneComponentNeedsNoThree) {
  const LinearProblem problem = springRod(20);
  for (const Separation separation : {Separation::kScalar, Separation::kHadamard}) {
    LinearPgdOptions options = quiet(20);
    options.separation = separation;
    options.components.assign(20, 0);
    const SeparatedSolution u = solveLinearPgd(problem, options);
    ASSERT_EQ(u.terms(), 1);
    const MatrixXd solution = u.X * u.Y[0];
    for (int x = 0; x < 20; ++x)
      for (int s = 0; s < 20; ++s) EXPECT_NEAR(solution(x, s), 1.0 + std::min(x, s), 1e-8);
  }
}

TEST(LinearPgdOptionsTest, NamesTheFirstBadField) {
  const LinearProblem problem = springRod(5);
  const auto refused = [&](auto change, const std::string& field) {
    LinearPgdOptions options = quiet(3);
    change(options);
    try {
      (void)solveLinearPgd(problem, options);
      ADD_FAILURE() << field << " was taken";
    } catch (const std::invalid_argument& e) {
      EXPECT_NE(std::string(e.what()).find(field), std::string::npos) << e.what();
    }
  };
  refused([](auto& o) { o.max_pairs = 0; }, "max_pairs = 0");
  refused([](auto& o) { o.load_terms = -1; }, "load_terms = -1");
  refused([](auto& o) { o.tolerance = 1.0; }, "tolerance = 1");
  refused([](auto& o) { o.max_sweeps = 0; }, "max_sweeps = 0");
  refused([](auto& o) { o.block = 0; }, "block = 0");
  refused([](auto& o) { o.probes = 1; }, "probes = 1");
  refused([](auto& o) { o.components = {0, 1}; }, "size of components = 2");
}

}  // namespace
}  // namespace palpate::solver
