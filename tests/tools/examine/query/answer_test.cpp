// SPDX-License-Identifier: Apache-2.0
#include "tools/examine/query/answer.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "box_model.h"
#include "core/response/patch_response.h"

namespace palpate::query::test {
namespace {

TEST(Answer, IsWhatTheServerWouldAnswer) {
  const BoxModel box;
  const Vec3 d(0.001, 0.0, -0.002);
  const Anchor anchor = anchorNear(box.model, {0.083, 0.031, 0.06});
  Response expected;
  ASSERT_EQ(respond(box.model, anchor.s, d, expected), ResponseStatus::kOk);
  std::vector<float> field(3 * box.organ.surface.nodes.size());
  FieldScratch scratch(box.model);
  evaluateField(box.model, anchor.s, d, scratch, field);

  const Answer answer = ask(box.model, anchor, d);
  EXPECT_EQ(answer.status, ResponseStatus::kOk);
  EXPECT_EQ(answer.response.force, expected.force);
  EXPECT_EQ(answer.response.stiffness, expected.stiffness);
  EXPECT_EQ(answer.field, field);
  EXPECT_GT(expected.force.norm(), 0.01);
}

TEST(Answer, FarBeyondItsPolynomialsTheFieldIsThatOfTheScaledDisplacement) {
  const BoxModel box;
  const Answer answer = ask(box.model, anchorAtNode(box.model, BoxMesh::number(5, 3, 2)), {0.0, 0.0, -0.09});
  EXPECT_EQ(answer.status, ResponseStatus::kBeyond);
  EXPECT_NEAR(answer.response.displacement.norm(), kShownRadii * answer.response.series_radius, 1e-15);
}

TEST(Anchor, AtANodeIsThatNode) {
  const BoxModel box;
  const Anchor anchor = anchorAtNode(box.model, BoxMesh::number(4, 2, 2));
  EXPECT_LT((anchor.position - Vec3(0.08, 0.04, 0.04)).norm(), 1e-15);
  EXPECT_EQ(box.model.surface().position(anchor.s), anchor.position);
  EXPECT_EQ(box.model.view().surface_mesh_tag[static_cast<std::size_t>(anchor.node)],
            BoxMesh::number(4, 2, 2));
}

TEST(Anchor, NearAPointIsOnTheSurfaceWithTheNearestNode) {
  const BoxModel box;
  const Anchor anchor = anchorNear(box.model, {0.083, 0.038, 0.07});
  EXPECT_LT((anchor.position - Vec3(0.083, 0.038, 0.04)).norm(), 1e-12);
  EXPECT_EQ(box.model.view().surface_mesh_tag[static_cast<std::size_t>(anchor.node)],
            BoxMesh::number(4, 2, 2));
}

TEST(Anchor, AtTheRimBelongsToATriangleThatMayBeTouched) {
  const BoxModel box;
  const Anchor anchor = anchorAtNode(box.model, BoxMesh::number(1, 1, 2));
  EXPECT_TRUE(box.model.surface().accessible(anchor.s.triangle));
  EXPECT_LT((box.model.surface().position(anchor.s) - anchor.position).norm(), 1e-15);
  EXPECT_EQ(ask(box.model, anchor, {0.0, 0.0, -0.001}).status, ResponseStatus::kOk);
}

TEST(Anchor, RefusesNodesByTheirNumber) {
  const BoxModel box;
  EXPECT_EQ(errorOf([&] { (void)anchorAtNode(box.model, 4); }),
            "node 4 is not in the mesh, which has 72 nodes");
  EXPECT_EQ(errorOf([&] { (void)anchorAtNode(box.model, BoxMesh::number(3, 1, 1)); }),
            "node " + std::to_string(BoxMesh::number(3, 1, 1)) +
                " lies inside the organ, expected one on its surface");
  EXPECT_EQ(errorOf([&] { (void)anchorAtNode(box.model, BoxMesh::number(0, 1, 1)); }),
            "node " + std::to_string(BoxMesh::number(0, 1, 1)) +
                " has no contact position: it is clamped or not accessible");
}

TEST(Answer, IsZeroWhereTheOrganIsNotAccessible) {
  const BoxModel box;
  const Answer answer = ask(box.model, anchorNear(box.model, {-0.01, 0.03, 0.02}), {0.001, 0.0, 0.0});
  EXPECT_EQ(answer.status, ResponseStatus::kNoAnswer);
  EXPECT_EQ(answer.response.force, Vec3(Vec3::Zero()));
  EXPECT_TRUE(std::all_of(answer.field.begin(), answer.field.end(), [](float u) { return u == 0.0F; }));
}

}  // namespace
}  // namespace palpate::query::test
