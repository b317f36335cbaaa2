// SPDX-License-Identifier: Apache-2.0
#include "tools/examine/query/full_solution.h"

#include <gtest/gtest.h>

#include <cmath>

#include "box_model.h"

namespace palpate::query::test {
namespace {

TEST(FullSolution, ModelAgreesOnATinyTouch) {
  const BoxModel box;
  const Anchor anchor = anchorAtNode(box.model, BoxMesh::number(3, 1, 2));
  const Vec3 d(2e-6, -3e-6, -6e-6);
  const Errors errors = errorsOf(ask(box.model, anchor, d), box.solve(anchor, d), box.organ);
  EXPECT_LT(errors.force, 6e-8);      // the patch's stiffness is summed from pairs in single precision
  EXPECT_LT(errors.field_max, 6e-5);  // the model's field is rounded to 16 bits
  EXPECT_LT(errors.field_l2, 4e-5);
}

TEST(FullSolution, ImposesWhatWasAskedForBeyondTheDomainToo) {
  const BoxModel box;
  const Anchor anchor = anchorAtNode(box.model, BoxMesh::number(5, 3, 2));
  const Vec3 d =
      Vec3(0.2, 0.3, -1.0).normalized() * 1.2 * ask(box.model, anchor, Vec3::Zero()).response.domain_radius;
  const FullSolution truth = box.solve(anchor, d);
  EXPECT_LT((truth.patch.average(truth.state.u) - d).norm(), 1e-9 * d.norm());
  EXPECT_GT(truth.min_det_f, 0.0);
  EXPECT_LT(truth.min_det_f, 1.0);
}

TEST(FullSolution, CentresThePatchAtThePointItself) {
  const BoxModel box;
  const Anchor anchor = anchorNear(box.model, {0.07, 0.03, 0.05});  // the middle of a cell's face
  const FullSolution truth = box.solve(anchor, {0.0, 0.0, -0.001});
  Vec3 centre = Vec3::Zero();
  for (std::size_t i = 0; i < truth.patch.nodes.size(); ++i)
    centre += truth.patch.weights[i] * box.organ.body.nodes()[static_cast<std::size_t>(truth.patch.nodes[i])];
  EXPECT_LT((centre.head<2>() - anchor.position.head<2>()).norm(), 0.002) << centre.transpose();
}

TEST(FullSolution, ErrorsAreRelativeToTheTruth) {
  const BoxModel box;
  const Anchor anchor = anchorAtNode(box.model, BoxMesh::number(4, 1, 2));
  const Vec3 d(0.0, 0.0, -0.001);
  const FullSolution truth = box.solve(anchor, d);
  Answer rest;
  rest.field.assign(3 * box.organ.surface.nodes.size(), 0.0F);
  double largest = 0.0;
  for (std::size_t i = 0; i < box.organ.surface.nodes.size(); ++i)
    largest = std::max(largest, truth.displacement(box.organ, static_cast<int>(i)).norm());
  const Errors errors = errorsOf(rest, truth, box.organ);
  EXPECT_NEAR(errors.force, 1.0, 1e-12);
  EXPECT_NEAR(errors.field_max, largest / 0.001, 1e-9);
  EXPECT_NEAR(errors.field_l2, 1.0, 1e-12);
  EXPECT_GT(largest, 0.001);  // the dimple is deeper than its average
}

TEST(FullSolution, AtRestHasNoErrors) {
  const BoxModel box;
  const Anchor anchor = anchorAtNode(box.model, BoxMesh::number(4, 1, 2));
  const Vec3 d = Vec3::Zero();
  const Errors errors = errorsOf(ask(box.model, anchor, d), box.solve(anchor, d), box.organ);
  EXPECT_EQ(errors.force, 0.0);
  EXPECT_EQ(errors.field_max, 0.0);
  EXPECT_EQ(errors.field_l2, 0.0);
}

TEST(FullSolution, NewtonTakesSoManyStepsAndNoMore) {
  const BoxModel box;
  const Anchor anchor = anchorAtNode(box.model, BoxMesh::number(4, 1, 2));
  const Vec3 d(0.0, 0.0, -0.01);
  const solver::Patch patch = box.solve(anchor, 0.01 * d).patch;
  solver::NewtonOptions options;
  options.max_iterations = 3;  // too few for the whole way at once
  EXPECT_NO_THROW((void)solver::NewtonSolver(box.organ.body).solvePatch(patch, d, options));
  options.extra_steps = 0;
  EXPECT_THROW((void)solver::NewtonSolver(box.organ.body).solvePatch(patch, d, options), std::runtime_error);
}

TEST(FullSolution, RefusesAPatchThatIsAllClamped) {
  const BoxModel box;
  const Anchor anchor = anchorNear(box.model, {-0.01, 0.03, 0.02});
  EXPECT_NE(errorOf([&] {
              (void)box.solve(anchor, {0.001, 0.0, 0.0});
            }).find("clamped nodes only"),
            std::string::npos);
}

// Longer ones than the program lets through: of those that it does, elements turn inside out before Newton fails.
TEST(FullSolution, RefusesADisplacementThatNewtonCannotReach) {
  const BoxModel box;
  const Anchor anchor = anchorAtNode(box.model, BoxMesh::number(5, 3, 2));
  EXPECT_EQ(errorOf([&] {
              (void)box.solve(anchor, {-1e100, 0.0, 0.0});
            }).find("displacement -1e+100,0,0 m: Newton does not converge"),
            0U);
}

TEST(FullSolution, OfAModelWithAStiffRegionOnSpringsIsThatOfTheModel) {
  const BoxModel box{"stvk", 1, BoxCase::kRegionAndSprings}, plain;
  for (const std::int64_t node : {BoxMesh::number(3, 1, 2), BoxMesh::number(5, 2, 2)}) {
    const Anchor anchor = anchorAtNode(box.model, node);
    const Vec3 tiny(2e-6, -3e-6, -6e-6), far(2e-4, -3e-4, -6e-4);
    EXPECT_LT(errorsOf(ask(box.model, anchor, tiny), box.solve(anchor, tiny), box.organ).force, 1e-7);
    const FullSolution truth = box.solve(anchor, far);
    EXPECT_LT(errorsOf(ask(box.model, anchor, far), truth, box.organ).force, 1e-5);
    // The region, whose modulus is five times the other's, and the bed are felt.
    EXPECT_GT(truth.state.force.norm(), 1.1 * plain.solve(anchor, far).state.force.norm());
  }
}

}  // namespace
}  // namespace palpate::query::test
