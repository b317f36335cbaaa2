// SPDX-License-Identifier: Apache-2.0
#include "tools/solver/fem/newton.h"

#include <gtest/gtest.h>

#include <array>

#include "../boxes.h"

namespace palpate::solver {
namespace {

/// A beam with two patches on its top face.
class TwoPatches : public ::testing::Test {
 protected:
  const Box box_{8, 4, 3, Vec3(0.16, 0.08, 0.06)};
  const FeModel model_{box_.clamped({{160e3, 0.4}})};
  const PatchSurface surface_{box_.surface(model_)};
  NewtonSolver newton_{model_};

  Patch patchAt(int i, int j) const {
    const int node = box_.node(i, j, 3);
    const auto at = std::find(surface_.nodes.begin(), surface_.nodes.end(), node) - surface_.nodes.begin();
    return makePatch(model_, surface_, surface_.atNode(static_cast<int>(at)), 0.012);
  }
};

TEST_F(TwoPatches, MoveAsImposedAndNothingElsePushes) {
  const std::array<ImposedPatch, 2> tools{ImposedPatch{patchAt(3, 2), Vec3(0.001, 0.0, -0.004)},
                                          ImposedPatch{patchAt(7, 2), Vec3(0.0, -0.002, -0.003)}};
  const NewtonResult result = newton_.solvePatches(tools, {});
  ASSERT_EQ(result.forces.size(), 2U);
  EXPECT_EQ(result.force, result.forces[0]);
  Eigen::VectorXd out_of_balance = model_.internalForce(result.u);
  const double largest = out_of_balance.cwiseAbs().maxCoeff();
  for (std::size_t a = 0; a < 2; ++a) {
    EXPECT_LT((tools[a].patch.average(result.u) - tools[a].d).norm(), 1e-11);
    tools[a].patch.addForce(-result.forces[a], out_of_balance);
  }
  for (int node = 0; node < model_.nodeCount(); ++node)
    if (model_.isFree(node)) {
      EXPECT_LT(out_of_balance.segment<3>(3 * node).norm(), 1e-9 * largest);
    }
}

TEST_F(TwoPatches, AToolThatGoesWithTheOrganHasNoForce) {
  const Patch first = patchAt(3, 2), second = patchAt(7, 1);
  const Vec3 d(0.001, 0.0, -0.004);
  const NewtonResult alone = newton_.solvePatch(first, d, {});
  const std::array<ImposedPatch, 2> tools{ImposedPatch{first, d},
                                          ImposedPatch{second, second.average(alone.u)}};
  const NewtonResult both = newton_.solvePatches(tools, {});
  EXPECT_LT(both.forces[1].norm(), 1e-7 * alone.force.norm());
  EXPECT_LT((both.forces[0] - alone.force).norm(), 1e-7 * alone.force.norm());
  EXPECT_LT((both.u - alone.u).cwiseAbs().maxCoeff(), 1e-9);
}

TEST_F(TwoPatches, AToolThatHoldsStillIsPushed) {
  const std::array<ImposedPatch, 2> tools{ImposedPatch{patchAt(3, 2), Vec3(0.0, 0.0, -0.004)},
                                          ImposedPatch{patchAt(7, 2), Vec3::Zero()}};
  const NewtonResult both = newton_.solvePatches(tools, {});
  EXPECT_LT(tools[1].patch.average(both.u).norm(), 1e-11);
  EXPECT_GT(both.forces[1].z(), 0.1 * -both.forces[0].z());
}

TEST_F(TwoPatches, WithoutTravelAreAtRest) {
  const std::array<ImposedPatch, 2> tools{ImposedPatch{patchAt(3, 2), Vec3::Zero()},
                                          ImposedPatch{patchAt(7, 2), Vec3::Zero()}};
  const NewtonResult both = newton_.solvePatches(tools, {});
  EXPECT_EQ(both.forces.size(), 2U);
  EXPECT_EQ(both.u.norm(), 0.0);
}

TEST_F(TwoPatches, AtOnePlaceThatShouldMoveApartHaveNoSolution) {
  const std::array<ImposedPatch, 2> tools{ImposedPatch{patchAt(3, 2), Vec3(0.0, 0.0, -0.004)},
                                          ImposedPatch{patchAt(3, 2), Vec3(0.0, 0.0, -0.002)}};
  EXPECT_THROW((void)newton_.solvePatches(tools, {}), std::runtime_error);
}

TEST_F(TwoPatches, BeginningNearTheSolutionLeadsToIt) {
  const Patch patch = patchAt(3, 2);
  const Vec3 d(0.001, 0.0, -0.008);
  const NewtonResult from_rest = newton_.solvePatch(patch, d, {});
  NewtonOptions holding;
  holding.held = 0.3;
  for (const NewtonOptions& options : {NewtonOptions{}, holding}) {
    const ImposedPatch tool{patch, d};
    const auto result = newton_.solvePatchesFrom(0.97 * from_rest.u, std::span(&tool, 1), options);
    ASSERT_TRUE(result);
    EXPECT_LT((result->u - from_rest.u).cwiseAbs().maxCoeff(), 1e-9 * d.norm());
    EXPECT_LT((result->force - from_rest.force).norm(), 1e-7 * from_rest.force.norm());
    EXPECT_LE(result->residual, options.tolerance);
  }
}

TEST_F(TwoPatches, AFactorThatIsHeldLeadsToTheSameSolutionMoreSlowly) {
  const Patch patch = patchAt(3, 2);
  const Vec3 d(0.001, 0.0, -0.008);
  NewtonOptions holding;
  holding.held = 0.3;
  const NewtonResult own = newton_.solvePatch(patch, d, {}), held = newton_.solvePatch(patch, d, holding);
  EXPECT_LT((own.u - held.u).cwiseAbs().maxCoeff(), 1e-8 * d.norm());
  EXPECT_GT(held.iterations, own.iterations);
}

TEST_F(TwoPatches, ABeginningThatLeadsNowhereGivesNothing) {
  const ImposedPatch tool{patchAt(3, 2), Vec3(0.0, 0.0, -0.001)};
  const Eigen::VectorXd wild = Eigen::VectorXd::Random(3 * model_.nodeCount());  // metres
  NewtonOptions options;
  options.max_iterations = 3;
  EXPECT_FALSE(newton_.solvePatchesFrom(wild, std::span(&tool, 1), options));
}

TEST_F(TwoPatches, ABeginningThatIsLostEndsEarly) {
  const ImposedPatch tool{patchAt(3, 2), Vec3(0.001, 0.0, -0.008)};
  NewtonOptions options;
  const auto found = newton_.solvePatches(std::span(&tool, 1), options);
  ASSERT_GE(found.iterations, 3);
  const Eigen::VectorXd rest = Eigen::VectorXd::Zero(3 * model_.nodeCount());
  ASSERT_TRUE(newton_.solvePatchesFrom(rest, std::span(&tool, 1), options));
  options.lost = 0.0;  // any residual is too large
  EXPECT_FALSE(newton_.solvePatchesFrom(rest, std::span(&tool, 1), options));
  options.lost = 1e3;
  EXPECT_TRUE(newton_.solvePatchesFrom(rest, std::span(&tool, 1), options));
}

}  // namespace
}  // namespace palpate::solver
