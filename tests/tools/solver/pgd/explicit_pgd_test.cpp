// SPDX-License-Identifier: Apache-2.0
#include "tools/solver/pgd/explicit_pgd.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "../boxes.h"
#include "tools/solver/fem/newton.h"
#include "tools/solver/fit/field_measures.h"
#include "tools/solver/pgd/rod.h"

namespace palpate::solver {
namespace {

ExplicitOptions quietly(LoadStepping scheme, int steps, double tolerance) {
  ExplicitOptions options;
  options.scheme = scheme;
  options.steps = steps;
  options.tolerance = tolerance;
  options.quiet = true;
  return options;
}

// Every position of a rod of ten elements; X spans everything, so that only the scheme is left.
double rodError(LoadStepping scheme, int steps) {
  const RodProblem rod(RodData{.elements = 10});
  const LevelSolution solution = solveExplicit(rod, quietly(scheme, steps, 1e-10));
  const Eigen::MatrixXd exact = exactSolution(rod);
  double worst = 0.0;
  for (int s = 0; s < rod.positions(); ++s)
    worst = std::max(worst, (evaluate(solution, s) - exact.col(s)).norm() / exact.col(s).norm());
  return worst;
}

double order(LoadStepping scheme) {
  return std::log2(rodError(scheme, 64) / rodError(scheme, 128));
}

TEST(LoadStepping, TenTermsConvergeWithOrderTwo) {
  EXPECT_NEAR(order(LoadStepping::kTenTerms), 2.0, 0.1);
}
TEST(LoadStepping, ForwardEulerWithOrderOne) {
  EXPECT_NEAR(order(LoadStepping::kForwardEuler), 1.0, 0.1);
}
TEST(LoadStepping, ConstantTangentWithOrderOne) {
  EXPECT_NEAR(order(LoadStepping::kConstantTangent), 1.0, 0.1);
}

TEST(LoadStepping, RodNeedsAPairForEveryElement) {
  const RodProblem rod(RodData{.elements = 12});
  EXPECT_EQ(solveExplicit(rod, quietly(LoadStepping::kTenTerms, 5, 1e-10)).pairs, 12);
}

TEST(LoadStepping, TheRodHasOneLevelFunctionAsItsStretchIsUniform) {
  const RodProblem rod(RodData{.elements = 6});
  EXPECT_EQ(solveExplicit(rod, quietly(LoadStepping::kTenTerms, 10, 1e-10)).levels(), 1);
}

/// A beam clamped at x = 0, pressed down at any node of its upper side.
struct Beam {
  Box box;
  double newtons;
  FeModel model{box.clamped({{1e6, 0.25}})};
  std::vector<int> top{upperNodes()};

  std::vector<int> upperNodes() const {
    std::vector<int> nodes = box.face(2, true);
    std::erase_if(nodes, [this](int node) { return !model.isFree(node); });
    return nodes;
  }
  BodyProblem problem() const {
    std::vector<Patch> patches;
    for (const int node : top) patches.push_back({{node}, {1.0}, 1.0});
    const Vec3 down(0.0, 0.0, -newtons);
    return BodyProblem(model, patchLoads(model, patches, {&down, 1}),
                       Eigen::VectorXd::Constant(static_cast<Eigen::Index>(top.size()), 1e-4));
  }
  Eigen::VectorXd newton(int s) const {
    Eigen::VectorXd load = Eigen::VectorXd::Zero(3 * model.nodeCount());
    load[3 * top[static_cast<std::size_t>(s)] + 2] = -newtons;
    return NewtonSolver(model).solveLoad(load, {.steps = 4}).u;
  }
};

const Box kBeam{8, 2, 2, Vec3(0.4, 0.04, 0.04)};
const Box kTinyBeam{4, 1, 1, Vec3(0.16, 0.04, 0.04)};

TEST(LoadStepping, OneStepIsTheLinearSolution) {
  const Beam beam{kTinyBeam, 5.0};
  const BodyProblem body = beam.problem();
  const Eigen::MatrixXd linear = Cholesky(body.stiffness()).solve(body.loads());
  for (const LoadStepping scheme :
       {LoadStepping::kTenTerms, LoadStepping::kForwardEuler, LoadStepping::kConstantTangent}) {
    const LevelSolution solution = solveExplicit(body, quietly(scheme, 1, 1e-10));
    for (int s = 0; s < body.positions(); ++s)
      EXPECT_LT((evaluate(solution, s) - linear.col(s)).norm(), 1e-8 * linear.col(s).norm()) << s;
  }
}

TEST(LoadStepping, SeparatedSolutionIsNewtonsAtEveryPosition) {
  const Beam beam{kBeam, 1.0};
  const BodyProblem body = beam.problem();
  const LevelSolution solution = solveExplicit(body, quietly(LoadStepping::kTenTerms, 20, 0.08));
  EXPECT_LT(solution.pairs, body.positions());
  for (int s = 0; s < body.positions(); ++s)
    EXPECT_LT(relativeErrorL2(beam.model, body.toNodes(evaluate(solution, s)), beam.newton(s)), 0.01) << s;
}

TEST(LoadStepping, ForwardEulerBendsLessThanNewton) {
  const Beam beam{kBeam, 2.0};
  const BodyProblem body = beam.problem();
  const int tip = body.positions() - 2;
  const double euler =
      evaluate(solveExplicit(body, quietly(LoadStepping::kForwardEuler, 20, 0.02)), tip).norm();
  EXPECT_LT(euler, 0.95 * beam.newton(tip).norm());
}

TEST(LoadStepping, ConstantTangentDivergesUnderLargeRotationAndSaysWhere) {
  const Beam beam{kBeam, 10.0};
  const BodyProblem body = beam.problem();
  try {
    (void)solveExplicit(body, quietly(LoadStepping::kConstantTangent, 50, 0.1));
    FAIL() << "a tangent of the beam at rest has found a solution at its tip";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("at load level 0."), std::string::npos) << error.what();
  }
}

// Without PGD: each position by itself, K_T D = t l - f_int.
Eigen::MatrixXd tenTermsAt(const BodyProblem& body, int s, int steps) {
  Eigen::MatrixXd levels = Eigen::MatrixXd::Zero(body.dofs(), steps + 1);
  Cholesky factor(body.stiffness());
  SparseMatrix K = body.stiffness();
  const Eigen::VectorXd load = body.loads().col(s);
  for (int j = 1; j <= steps; ++j) {
    const Eigen::VectorXd u = levels.col(j - 1);
    body.tangent(u, K);
    factor.factorize(K);
    levels.col(j) = u + factor.solve(static_cast<double>(j) / steps * load - body.internalForce(u));
  }
  return levels;
}

TEST(LoadStepping, LevelFunctionsReproduceEveryStep) {
  const Beam beam{kTinyBeam, 10.0};
  const BodyProblem body = beam.problem();
  const int steps = 6, s = 5;
  const LevelSolution solution = solveExplicit(body, quietly(LoadStepping::kTenTerms, steps, 1e-10));
  const Eigen::MatrixXd levels = tenTermsAt(body, s, steps);
  EXPECT_EQ(solution.Z.col(0).norm(), 0.0);
  for (int j = 0; j <= steps; ++j)
    EXPECT_LT((evaluate(solution, s, static_cast<double>(j) / steps) - levels.col(j)).norm(),
              1e-7 * levels.col(steps).norm())
        << j;
  const Eigen::VectorXd between = 0.5 * (levels.col(2) + levels.col(3));
  EXPECT_LT((evaluate(solution, s, 2.5 / steps) - between).norm(), 1e-7 * between.norm());
}

TEST(LoadStepping, PairsAreBornWhenNeeded) {
  const Beam beam{kBeam, 2.0};
  const BodyProblem body = beam.problem();
  const LevelSolution coarse = solveExplicit(body, quietly(LoadStepping::kTenTerms, 10, 0.2));
  const LevelSolution fine = solveExplicit(body, quietly(LoadStepping::kTenTerms, 10, 0.05));
  EXPECT_GT(fine.pairs, coarse.pairs);
  EXPECT_GT(fine.born[0], fine.pairs / 2);  // the first step finds the linear solution
  EXPECT_GT(fine.pairs, fine.born[0]);      // rotation asks for more as the load grows
  EXPECT_NE(std::count(fine.born.begin(), fine.born.end(), 0), 0);  // and most steps need none
  ASSERT_EQ(fine.residual.size(), 10U);
  for (const double residual : fine.residual) EXPECT_LE(residual, 0.05);
}

// Five pairs after one step; rho_s = l_s - K0 u_s, relative to l_s, both in the dual norm of K0.
TEST(LoadStepping, ResidualIsTheWorstPositionsOrFromProbesTheirMean) {
  const Beam beam{kBeam, 1.0};
  const BodyProblem body = beam.problem();
  ExplicitOptions options = quietly(LoadStepping::kTenTerms, 1, 1e-10);
  options.max_pairs = 5;
  const LevelSolution solution = solveExplicit(body, options);
  const Cholesky K0(body.stiffness());
  Eigen::VectorXd squares(body.positions());
  for (int s = 0; s < body.positions(); ++s) {
    const Eigen::VectorXd load = body.loads().col(s);
    const Eigen::VectorXd rho = load - body.stiffness() * evaluate(solution, s);
    squares[s] = rho.dot(K0.solve(rho).col(0)) / load.dot(K0.solve(load).col(0));
  }
  EXPECT_NEAR(solution.residual[0], std::sqrt(squares.maxCoeff()), 1e-6 * solution.residual[0]);
  options.exact_residuals = 0;
  options.probes = 400;
  const double rms = std::sqrt(squares.mean());
  EXPECT_NEAR(solveExplicit(body, options).residual[0], rms, 0.15 * rms);
}

TEST(LoadStepping, TangentsWithoutAPlaceInMemoryAreAssembledAgain) {
  const Beam beam{kTinyBeam, 10.0};
  const BodyProblem body = beam.problem();
  ExplicitOptions options = quietly(LoadStepping::kTenTerms, 4, 0.01);
  options.workers = 1;
  const Eigen::VectorXd kept = evaluate(solveExplicit(body, options), 3);
  options.tangent_bytes = 0.0;
  EXPECT_LT((evaluate(solveExplicit(body, options), 3) - kept).norm(), 1e-9 * kept.norm());
}

TEST(LoadStepping, RecompressionMakesRoomAndKeepsTheSolution) {
  const Beam beam{kBeam, 2.0};
  const BodyProblem body = beam.problem();
  ExplicitOptions options = quietly(LoadStepping::kTenTerms, 20, 0.05);
  const LevelSolution free = solveExplicit(body, options);
  options.max_pairs = free.pairs - 2;
  const LevelSolution held = solveExplicit(body, options);
  EXPECT_GT(held.recompressions, 0);
  EXPECT_LE(held.pairs, free.pairs - 2);
  const int tip = body.positions() - 2;
  EXPECT_LT((evaluate(held, tip) - evaluate(free, tip)).norm(), 0.01 * evaluate(free, tip).norm());
}

TEST(LoadStepping, FewerModesAreTheBestOfAllPairs) {
  const Beam beam{kBeam, 1.0};
  const BodyProblem body = beam.problem();
  ExplicitOptions options = quietly(LoadStepping::kTenTerms, 10, 0.05);
  const LevelSolution all = solveExplicit(body, options);
  options.modes = 8;
  const LevelSolution cut = solveExplicit(body, options);
  EXPECT_EQ(cut.modes(), 8);
  EXPECT_EQ(cut.pairs, all.pairs);
  const int tip = body.positions() - 2;
  EXPECT_LT((evaluate(cut, tip) - evaluate(all, tip)).norm(), 0.01 * evaluate(all, tip).norm());
}

TEST(LoadStepping, RefusesWhatItCannotWalk) {
  const RodProblem rod(RodData{.elements = 3});
  EXPECT_THROW((void)solveExplicit(rod, quietly(LoadStepping::kTenTerms, 0, 0.1)), std::invalid_argument);
  EXPECT_THROW((void)solveExplicit(rod, quietly(LoadStepping::kTenTerms, 1, 0.0)), std::invalid_argument);
  const LevelSolution solution = solveExplicit(rod, quietly(LoadStepping::kTenTerms, 1, 0.1));
  EXPECT_THROW((void)evaluate(solution, 3), std::invalid_argument);
  EXPECT_THROW((void)evaluate(solution, 0, 1.1), std::invalid_argument);
}

}  // namespace
}  // namespace palpate::solver
