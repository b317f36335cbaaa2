// SPDX-License-Identifier: Apache-2.0
#include "tools/solver/fem/ordered_solver.h"

#include <gtest/gtest.h>

#include "../boxes.h"

namespace palpate::solver {
namespace {

constexpr int kColumns = 5;

class OrderedSolution : public ::testing::Test {
 protected:
  const FeModel model_ = Box{6, 5, 4, Vec3(0.06, 0.05, 0.04)}.clamped({{160e3, 0.45}});
  Cholesky factor_{model_};

  OrderedSolution() { factor_.factorize(Eigen::VectorXd::Zero(3 * model_.nodeCount())); }

  /// Largest difference from CHOLMOD's own solution, relative.
  double errorFor(const Eigen::MatrixXd& b) {
    const std::span<const int> order = factor_.order();
    std::vector<double> rows;
    for (const int dof : order)
      for (int c = 0; c < kColumns; ++c) rows.push_back(b(dof, c));
    OrderedSolver solver(factor_);
    solver.solve(rows, kColumns);
    const Eigen::MatrixXd x = factor_.solve(b);
    double worst = 0.0;
    for (std::size_t i = 0; i < order.size(); ++i)
      for (int c = 0; c < kColumns; ++c)
        worst = std::max(worst, std::abs(rows[i * kColumns + static_cast<std::size_t>(c)] - x(order[i], c)));
    return worst / x.cwiseAbs().maxCoeff();
  }
};

TEST_F(OrderedSolution, IsThatOfCholmod) {
  EXPECT_LT(errorFor(Eigen::MatrixXd::Random(model_.dofCount(), kColumns)), 1e-12);
}

TEST_F(OrderedSolution, LeavesOutOnlyWhatIsZero) {
  for (int dof = 0; dof < model_.dofCount(); dof += 17) {
    Eigen::MatrixXd b = Eigen::MatrixXd::Zero(model_.dofCount(), kColumns);
    b(dof, dof % kColumns) = 1.0;
    EXPECT_LT(errorFor(b), 1e-12) << dof;
  }
}

TEST(Cholesky, NamesTheUnknownWhereAMatrixIsNotPositiveDefinite) {
  SparseMatrix K(4, 4);
  const Eigen::Vector4d diagonal(2.0, 3.0, -1.0, 4.0);
  for (int i = 0; i < 4; ++i) K.insert(i, i) = diagonal[i];
  K.makeCompressed();
  const Cholesky factor(K);
  EXPECT_EQ(factor.indefiniteAt(), 2);
  EXPECT_THROW(OrderedSolver{factor}, std::invalid_argument);
  try {
    factor.requirePositiveDefinite("K");
    FAIL() << "an indefinite matrix passed";
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(), "K is not positive definite, at unknown 2 of 4");
  }
}

TEST(Cholesky, NamesTheUnknownWhereAMatrixIsSingular) {
  SparseMatrix K(3, 3);
  K.insert(0, 0) = 2.0;
  K.insert(1, 1) = 0.0;
  K.insert(2, 2) = 1.0;
  K.makeCompressed();
  try {
    const Cholesky factor(K);
    FAIL() << "a singular matrix has a factor";
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(), "the tangent stiffness is singular, at unknown 1 of 3");
  }
}

}  // namespace
}  // namespace palpate::solver
