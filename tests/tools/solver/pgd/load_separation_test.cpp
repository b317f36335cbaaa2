// SPDX-License-Identifier: Apache-2.0
#include "tools/solver/pgd/load_separation.h"

#include <gtest/gtest.h>

#include <Eigen/SVD>
#include <cmath>
#include <stdexcept>

#include "../linear_problems.h"

namespace palpate::solver {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

class LoadSeparation : public ::testing::Test {
 protected:
  const PalpatedBox box_;
  const BodyProblem problem_{box_.problem({-Vec3::UnitZ()})};

  MatrixXd separated(const SeparatedLoad& load) const {
    return load.times(MatrixXd::Identity(problem_.positions(), problem_.positions()));
  }
  double norm(const MatrixXd& l) const {
    return std::sqrt(l.cwiseAbs2().colwise().sum().dot(problem_.weights()));
  }
};

TEST_F(LoadSeparation, WithoutTruncationTheLoadsAreKept) {
  for (const int terms : {0, problem_.positions()}) {
    const SeparatedLoad load(problem_.loads(), problem_.weights(), terms);
    EXPECT_EQ(load.truncationError(), 0.0);
    EXPECT_EQ(separated(load), MatrixXd(problem_.loads()));
  }
}

TEST_F(LoadSeparation, ErrorIsThatOfTheBestTermsInTheWeights) {
  const MatrixXd exact = problem_.loads();
  const VectorXd sigma =
      Eigen::JacobiSVD<MatrixXd>(exact * problem_.weights().cwiseSqrt().asDiagonal()).singularValues();
  for (const int terms : {1, 4, 10, 20}) {
    const SeparatedLoad load(problem_.loads(), problem_.weights(), terms);
    EXPECT_EQ(load.terms(), terms);
    const double error = norm(separated(load) - exact) / norm(exact);
    EXPECT_NEAR(load.truncationError(), error, 1e-7);
    const double best = sigma.tail(sigma.size() - terms).norm() / sigma.norm();
    EXPECT_NEAR(error, best, 1e-4 * best);
  }
}

TEST_F(LoadSeparation, BothProductsAreOfTheSameLoad) {
  const SeparatedLoad load(problem_.loads(), problem_.weights(), 7);
  const MatrixXd l = separated(load);
  const MatrixXd Q = MatrixXd::Random(problem_.dofs(), 3);
  EXPECT_LT((load.project(Q) - Q.transpose() * l).norm(), 1e-12 * l.norm());
}

TEST_F(LoadSeparation, RefusesWeightsThatDoNotFit) {
  EXPECT_THROW(SeparatedLoad(problem_.loads(), VectorXd::Ones(3), 0), std::invalid_argument);
  EXPECT_THROW(SeparatedLoad(problem_.loads(), problem_.weights(), -1), std::invalid_argument);
}

}  // namespace
}  // namespace palpate::solver
