// SPDX-License-Identifier: Apache-2.0
#include "tools/solver/fem/ordered_solver.h"

#include <gtest/gtest.h>

#include <functional>
#include <set>
#include <string>

#include "../boxes.h"
#include "palpate/testing/instruction_sets.h"
#include "tools/solver/fem/block_kernel.h"

namespace palpate::solver {
namespace {

class OrderedSolution : public ::testing::TestWithParam<int> {
 protected:
  const FeModel model_ = Box{6, 5, 4, Vec3(0.06, 0.05, 0.04)}.clamped({{160e3, 0.45}});
  Cholesky factor_{model_};
  const int lanes_ = GetParam(), columns_ = lanes_ * kLanes;

  OrderedSolution() { factor_.factorize(Eigen::VectorXd::Zero(3 * model_.nodeCount())); }

  /// With the kernels of each instruction set that this processor has.
  static void onEverySet(const std::function<void()>& body) {
    const testing::InstructionSets sets;
    std::set<std::string> names;
    for (const std::int64_t set : sets.list()) {
      hwy::SetSupportedTargetsForTest(set);
      hwy::GetChosenTarget().Update(hwy::SupportedTargets());
      const std::string name = blockKernel();
      SCOPED_TRACE(name);
      names.insert(name);
      body();
    }
    EXPECT_GT(names.size(), 1U);
  }

  /// Largest difference from CHOLMOD's own solution, relative.
  double errorFor(const Eigen::MatrixXd& b) {
    const std::span<const int> order = factor_.order();
    LaneVector rows(order.size() * static_cast<std::size_t>(lanes_));
    const auto at = [&](std::size_t row, int c) -> Lanes& {
      return rows[row * static_cast<std::size_t>(lanes_) + static_cast<std::size_t>(c / kLanes)];
    };
    for (std::size_t i = 0; i < order.size(); ++i)
      for (int c = 0; c < columns_; ++c) at(i, c)[c % kLanes] = b(order[i], c);
    OrderedSolver solver(factor_);
    solver.solve(rows, lanes_);
    const Eigen::MatrixXd x = factor_.solve(b);
    double worst = 0.0;
    for (std::size_t i = 0; i < order.size(); ++i)
      for (int c = 0; c < columns_; ++c)
        worst = std::max(worst, std::abs(at(i, c)[c % kLanes] - x(order[i], c)));
    return worst / x.cwiseAbs().maxCoeff();
  }
};

TEST_P(OrderedSolution, IsThatOfCholmod) {
  const Eigen::MatrixXd b = Eigen::MatrixXd::Random(model_.dofCount(), columns_);
  onEverySet([&] { EXPECT_LT(errorFor(b), 1e-12); });
}

TEST_P(OrderedSolution, LeavesOutOnlyWhatIsZero) {
  for (int dof = 0; dof < model_.dofCount(); dof += 17) {
    Eigen::MatrixXd b = Eigen::MatrixXd::Zero(model_.dofCount(), columns_);
    b(dof, dof % columns_) = 1.0;
    onEverySet([&] { EXPECT_LT(errorFor(b), 1e-12) << dof; });
  }
}

// Panels of three vectors, and what is left of them on every processor.
INSTANTIATE_TEST_SUITE_P(Lanes, OrderedSolution, ::testing::Values(1, 2, 3, 4, 5),
                         [](const auto& of) { return std::to_string(of.param); });

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
