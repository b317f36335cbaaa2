// SPDX-License-Identifier: Apache-2.0
#include "tools/solver/pgd/recompression.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

#include "../linear_problems.h"
#include "tools/solver/pgd/energy_error.h"

namespace palpate::solver {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

MatrixXd product(const ScalarPairs& pairs) {
  return pairs.X * pairs.Y;
}

TEST(Orthonormalize, MakesAnOrthonormalBasisOfTheSameSpan) {
  const LinearProblem problem = springRod(60);
  MatrixXd V = MatrixXd::Random(60, 50);
  V.col(40) = 1e3 * V.col(3) - V.col(7);                   // dependent
  V.col(20) = V.col(19) + 1e-9 * MatrixXd::Random(60, 1);  // nearly so
  const OrthonormalBasis basis = orthonormalize(V, energyProduct(problem.stiffness()));
  EXPECT_LT((basis.Q * basis.R - V).norm(), 1e-12 * V.norm());
  MatrixXd expected = MatrixXd::Identity(50, 50);
  expected(40, 40) = 0.0;
  const MatrixXd gram = basis.Q.transpose() * (problem.stiffness() * basis.Q);
  EXPECT_LT((gram - expected).norm(), 1e-10);
}

TEST(Recompress, WithoutCuttingChangesNothing) {
  const LinearProblem problem = springRod(30);
  const ScalarPairs pairs{MatrixXd::Random(30, 12), MatrixXd::Random(12, 30)};
  const Recompressed r = recompress(pairs, energyProduct(problem.stiffness()), problem.weights(), 12);
  EXPECT_LT((product(r.pairs) - product(pairs)).norm(), 1e-12 * product(pairs).norm());
}

TEST(Recompress, ErrorIsTheTruncationOfTheSingularValues) {
  const LinearProblem problem = springRod(30);
  const ScalarPairs pairs{MatrixXd::Random(30, 12), MatrixXd::Random(12, 30)};
  const auto norm = [&](const MatrixXd& u) {
    return std::sqrt((u.cwiseProduct(problem.stiffness() * u)).colwise().sum().dot(problem.weights()));
  };
  for (const Eigen::Index n : {1, 5, 11}) {
    const Recompressed r = recompress(pairs, energyProduct(problem.stiffness()), problem.weights(), n);
    ASSERT_EQ(r.pairs.X.cols(), n);
    EXPECT_NEAR(norm(product(r.pairs) - product(pairs)) / norm(product(pairs)), r.truncation(n), 1e-12);
    const VectorXd row_norms = (r.pairs.Y.cwiseAbs2() * problem.weights()).cwiseSqrt();
    EXPECT_LT((row_norms - r.singular_values.head(n)).norm(), 1e-12 * row_norms.norm());
  }
}

TEST(Recompress, MeetsTheBestErrorWhenThePairsSpanTheSolution) {
  const LinearProblem problem = springRod(40);
  ScalarPairs pairs{MatrixXd::Random(40, 40), MatrixXd()};
  const MatrixXd solution = Cholesky(problem.stiffness()).solve(MatrixXd(problem.loads()));
  pairs.Y = pairs.X.fullPivLu().solve(solution);
  const VectorXd sigma = energySingularValues(complianceMatrix(problem, 1), problem.weights());
  for (const Eigen::Index n : {3, 10, 25}) {
    const Recompressed r = recompress(pairs, energyProduct(problem.stiffness()), problem.weights(), n);
    EXPECT_NEAR(energyError(problem, r.pairs, 1) / bestError(sigma, n), 1.0, 1e-6) << n;
  }
}

TEST(Recompress, PairsThatSayTheSameBecomeOne) {
  const VectorXd x = VectorXd::Random(9), y = VectorXd::Random(5);
  ScalarPairs pairs{MatrixXd(9, 3), MatrixXd(3, 5)};
  pairs.X << x, 2.0 * x, -x;
  pairs.Y << y.transpose(), y.transpose(), 4.0 * y.transpose();
  const Recompressed r = recompress(pairs, diagonalProduct(VectorXd::Constant(9, 2.0)), VectorXd::Ones(5), 3);
  EXPECT_EQ(r.pairs.X.cols(), 1);
  EXPECT_LT((product(r.pairs) - product(pairs)).norm(), 1e-13);
}

TEST(Recompress, RefusesWeightsThatDoNotFit) {
  const ScalarPairs pairs{MatrixXd::Random(9, 3), MatrixXd::Random(3, 5)};
  const InnerProduct plain = diagonalProduct(VectorXd::Ones(9));
  EXPECT_THROW((void)recompress(pairs, plain, VectorXd::Ones(4), 2), std::invalid_argument);
  EXPECT_THROW((void)recompress(pairs, plain, VectorXd::Ones(5), 0), std::invalid_argument);
}

}  // namespace
}  // namespace palpate::solver
