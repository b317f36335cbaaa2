// SPDX-License-Identifier: Apache-2.0
#include "tools/examine/query/together.h"

#include <gtest/gtest.h>

#include <array>
#include <map>

#include "box_model.h"
#include "core/response/tool_coupling.h"

namespace palpate::query::test {
namespace {

/// Two tools on the top of the box, 40 mm apart along it.
std::array<Touch, 2> twoTouches(const BoxModel& box, double scale) {
  return {Touch{anchorAtNode(box.model, BoxMesh::number(3, 1, 2)), scale * Vec3(0.0002, 0.0, -0.001)},
          Touch{anchorAtNode(box.model, BoxMesh::number(5, 1, 2)), scale * Vec3(0.0, 0.0003, -0.0008)}};
}

FullSolution solveTogether(const BoxModel& box, std::span<const Touch> touches) {
  return query::solveTogether(box.organ, touches, box.model.attributes().patch_radius, 1);
}

TEST(Together, ThePatchesOfTheModelAreThoseOfTheSolver) {
  const BoxModel box;
  const solver::PatchSurface& surface = box.organ.surface;
  for (std::int32_t m = 0; m < static_cast<std::int32_t>(box.model.view().positions()); ++m) {
    const std::int32_t node = box.model.view().contact_node[static_cast<std::size_t>(m)];
    const solver::Patch patch =
        solver::makePatch(box.organ.body, surface, surface.atNode(node), box.model.attributes().patch_radius);
    std::map<std::int32_t, double> expected;
    for (std::size_t i = 0; i < patch.nodes.size(); ++i) expected[patch.nodes[i]] = patch.weights[i];
    PatchNodes found = box.model.patches().room();
    box.model.patches().at(surface.atNode(node), false, found);
    ASSERT_EQ(found.count, expected.size());
    for (std::size_t i = 0; i < found.count; ++i)
      EXPECT_NEAR(found.weight[i], expected.at(surface.nodes[static_cast<std::size_t>(found.node[i])]),
                  1e-12);
  }
}

TEST(Together, TinyTouchesAreAsNewtonSays) {
  const BoxModel box;
  const auto touches = twoTouches(box, 1e-4);
  const JointAnswer answer = askTogether(box.model, touches);
  const FullSolution truth = solveTogether(box, touches);
  const JointErrors coupled = coupledErrors(answer, touches, truth, box.organ);
  const JointErrors superposed = superposedErrors(answer, touches, truth, box.organ);
  for (std::size_t a = 0; a < 2; ++a) {
    EXPECT_LT(coupled.force[a], 2.5e-4) << "tool " << a + 1;  // the field is rounded to 16 bits
    EXPECT_GT(superposed.force[a], 0.1) << "tool " << a + 1;
  }
  EXPECT_LT(coupled.field.max, 2.5e-4);  // two fields that are rounded to 16 bits and partly cancel
  EXPECT_GT(superposed.field.max, 0.1);
}

TEST(Together, CouplingLeavesOnlyTheOrgansOwnNonlinearity) {
  const BoxModel box;
  const auto touches = twoTouches(box, 1.5);
  const JointAnswer answer = askTogether(box.model, touches);
  const FullSolution truth = solveTogether(box, touches);
  const JointErrors coupled = coupledErrors(answer, touches, truth, box.organ);
  const JointErrors superposed = superposedErrors(answer, touches, truth, box.organ);
  for (std::size_t a = 0; a < 2; ++a) {
    EXPECT_LT(coupled.force[a], 0.2 * superposed.force[a]);
    EXPECT_GT(coupled.force[a], 1e-6);
  }
  EXPECT_LT(coupled.field.max, 0.2 * superposed.field.max);
}

TEST(Together, WorkIsReciprocal) {
  const BoxModel box;
  const auto touches = twoTouches(box, 1e-3);
  constexpr double kStep = 1e-9;  // m, of slopes
  std::array<palpate::Touch, 2> asked{palpate::Touch(box.model), palpate::Touch(box.model)};
  for (std::size_t a = 0; a < 2; ++a)
    touchWith(box.model, touches[a].anchor.s, touches[a].d, kStep, asked[a]);
  std::array<Vec3, 2> f, moved;
  for (std::size_t a = 0; a < 2; ++a) {
    f[a] = ask(box.model, touches[a].anchor, touches[a].d).response.force;
    moved[a] = patchMotion(box.model, asked[1 - a], asked[a]).at(Vec3::Zero());
  }
  EXPECT_NEAR(f[0].dot(moved[0]), f[1].dot(moved[1]), 1e-5 * std::abs(f[0].dot(touches[0].d)));
  EXPECT_GT(std::abs(f[0].dot(moved[0])), 0.05 * std::abs(f[0].dot(touches[0].d)));
}

TEST(Together, AToolThatHoldsStillFeelsTheOther) {
  const BoxModel box;
  auto touches = twoTouches(box, 0.1);
  touches[1].d.setZero();
  const JointAnswer answer = askTogether(box.model, touches);
  const FullSolution truth = solveTogether(box, touches);
  const Vec3 f = answer.tools[1].together.response.force;
  EXPECT_EQ(answer.tools[1].alone.response.force.norm(), 0.0);
  EXPECT_GT(f.norm(), 0.1 * answer.tools[0].together.response.force.norm());
  EXPECT_LT((f - truth.state.forces[1]).norm(), 0.02 * f.norm());
}

TEST(Together, TouchesAreRefusedByNameAndNumber) {
  const BoxModel box;
  const auto two = twoTouches(box, 1.0);
  const std::vector<Touch> five(5, two[0]);
  EXPECT_EQ(errorOf([&] { checkTouches(box.model, five); }), "--tool2 is given 4 times, expected at most 3");
  const std::array<Touch, 2> same{two[0], Touch{two[0].anchor, Vec3::Zero()}};
  EXPECT_EQ(errorOf([&] { checkTouches(box.model, same); }), "tools 1 and 2 both touch node " +
                                                                 std::to_string(BoxMesh::number(3, 1, 2)) +
                                                                 ", expected different places");
  const std::array<Touch, 2> held{Touch{anchorNear(box.model, {-0.01, 0.03, 0.02}), Vec3::Zero()}, two[0]};
  EXPECT_NE(errorOf([&] { checkTouches(box.model, held); }).find("is not at an accessible point"),
            std::string::npos);
  EXPECT_EQ(errorOf([&] { checkTouches(box.model, two); }), "");
  EXPECT_EQ(errorOf([&] { (void)parseTouch(box.model, "--tool2", "4:0,0,0"); }),
            "node 4 is not in the mesh, which has 72 nodes");
}

}  // namespace
}  // namespace palpate::query::test
