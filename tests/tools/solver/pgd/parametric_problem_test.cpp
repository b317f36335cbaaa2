// SPDX-License-Identifier: Apache-2.0
#include "tools/solver/pgd/parametric_problem.h"

#include <gtest/gtest.h>

#include <random>

#include "../boxes.h"

namespace palpate::solver {
namespace {

Eigen::VectorXd randomVector(int size, double scale, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-scale, scale);
  Eigen::VectorXd v(size);
  for (double& x : v) x = uniform(random);
  return v;
}

class SmallBody : public ::testing::Test {
 protected:
  const Box box_{3, 2, 2, Vec3(0.03, 0.02, 0.02)};
  const FeModel model_{box_.clamped({{160e3, 0.48}})};
  const Patch patch_{{box_.node(3, 0, 0), box_.node(2, 1, 2)}, {0.25, 0.75}, 1.0};

  BodyProblem problem() const {
    const Vec3 down(0.0, 0.0, -2.0);
    return BodyProblem(model_, patchLoads(model_, {&patch_, 1}, {&down, 1}), Eigen::VectorXd::Ones(1));
  }
};

TEST_F(SmallBody, TangentIsDerivativeOfForce) {
  const BodyProblem body = problem();
  const Eigen::VectorXd u = randomVector(body.dofs(), 5e-4, 1);
  const Eigen::VectorXd v = randomVector(body.dofs(), 1.0, 2);
  SparseMatrix K = body.stiffness();
  body.tangent(u, K);
  const double h = 1e-7;
  const Eigen::VectorXd difference =
      (body.internalForce(u + h * v) - body.internalForce(u - h * v)) / (2.0 * h);
  EXPECT_LT((K * v - difference).norm(), 1e-7 * difference.norm());
  EXPECT_GT((K * v - body.stiffness() * v).norm(), 1e-3 * difference.norm());
}

TEST_F(SmallBody, TangentIsSymmetric) {
  const BodyProblem body = problem();
  SparseMatrix K = body.stiffness();
  body.tangent(randomVector(body.dofs(), 5e-4, 3), K);
  const Eigen::MatrixXd dense = K;
  EXPECT_LT((dense - dense.transpose()).norm(), 1e-13 * dense.norm());
}

TEST_F(SmallBody, FactorOfAMatrixSolvesLikeTheModels) {
  const BodyProblem body = problem();
  const Eigen::VectorXd u = randomVector(body.dofs(), 2e-4, 4);
  const Eigen::MatrixXd b = randomVector(2 * body.dofs(), 1.0, 5).reshaped(body.dofs(), 2);
  Cholesky model_factor(model_);
  model_factor.factorize(body.toNodes(u));
  SparseMatrix K = body.stiffness();
  Cholesky matrix_factor(K);
  body.tangent(u, K);
  matrix_factor.factorize(K);
  const Eigen::MatrixXd expected = model_factor.solve(b);
  EXPECT_LT((matrix_factor.solve(b) - expected).norm(), 1e-10 * expected.norm());
}

TEST_F(SmallBody, FactorRefusesAMatrixOfAnotherPatternOrSize) {
  const BodyProblem body = problem();
  Cholesky factor(body.stiffness());
  SparseMatrix diagonal(body.dofs(), body.dofs());
  diagonal.setIdentity();
  EXPECT_THROW(factor.factorize(diagonal), std::invalid_argument);
  SparseMatrix small(3, 3);
  small.setIdentity();
  EXPECT_THROW(factor.factorize(small), std::invalid_argument);
}

TEST_F(SmallBody, FactorRefusesAPatternThatEndsEarly) {
  SparseMatrix full =
      Eigen::MatrixXd(Eigen::MatrixXd::Constant(2, 2, 0.5) + Eigen::MatrixXd::Identity(2, 2)).sparseView();
  Cholesky factor(full);
  SparseMatrix diagonal(2, 2);
  diagonal.insert(0, 0) = 1.0;
  diagonal.insert(1, 1) = 1.0;
  EXPECT_THROW(factor.factorize(diagonal), std::invalid_argument);
  full.coeffRef(1, 1) = 2.0;
  EXPECT_NO_THROW(factor.factorize(full));
}

TEST_F(SmallBody, LoadsAreForcesSpreadOverThePatch) {
  const std::vector<Vec3> forces{Vec3::UnitX(), Vec3(0.0, 2.0, -4.0)};
  const Eigen::MatrixXd loads = patchLoads(model_, {&patch_, 1}, forces);
  ASSERT_EQ(loads.cols(), 2);
  EXPECT_EQ(loads.col(0).sum(), 1.0);
  EXPECT_EQ(Vec3(loads.col(1).segment<3>(model_.dof(patch_.nodes[0]))), Vec3(0.0, 0.5, -1.0));
  EXPECT_EQ(Vec3(loads.col(1).segment<3>(model_.dof(patch_.nodes[1]))), Vec3(0.0, 1.5, -3.0));
  EXPECT_EQ((loads.col(1).array() != 0.0).count(), 4);
}

TEST_F(SmallBody, ClampedNodesStayAtRest) {
  const BodyProblem body = problem();
  const Eigen::VectorXd nodal = body.toNodes(Eigen::VectorXd::Ones(body.dofs()));
  ASSERT_FALSE(model_.fixedNodes().empty());
  for (const int node : model_.fixedNodes()) EXPECT_EQ(nodal.segment<3>(3 * node).norm(), 0.0);
  EXPECT_EQ(nodal.sum(), body.dofs());
}

TEST_F(SmallBody, RefusesLoadsThatDoNotFit) {
  EXPECT_THROW(BodyProblem(model_, SparseMatrix(5, 1), Eigen::VectorXd::Ones(1)), std::invalid_argument);
  EXPECT_THROW(BodyProblem(model_, SparseMatrix(model_.dofCount(), 2), Eigen::VectorXd::Ones(1)),
               std::invalid_argument);
}

}  // namespace
}  // namespace palpate::solver
