// SPDX-License-Identifier: Apache-2.0
// A tool on a model whose parameter is the force.
#include <algorithm>

#include "../load_driven.h"

namespace palpate::testing {

TEST(ForceModelStep, PressIsAnsweredByTheModelsForceOnTheTool) {
  const MetaModel& model = forceModel();
  Driver driver(model);
  driver.settle(above(model, -0.002));
  for (double z = -0.002; z < 0.002; z += 1e-4) driver.at(above(model, z));
  const ToolResult& tool = driver.settle(above(model, 0.002));
  EXPECT_EQ(tool.flags, kInContact);
  const ContactPoint s = model.surface().closestPoint(Vec3(0.0, 0.0, 1.0)).s;
  const Response out = answerTo(model, s, vec(tool.displacement), ResponseStatus::kOk);
  EXPECT_GT(vec(tool.force).z(), 0.0);
  EXPECT_LT((vec(tool.force) + out.force).norm(), 1e-9 * out.force.norm());
  const std::vector<float> u = field(model, s, out.force);
  for (std::size_t i = 0; i < u.size(); ++i) ASSERT_NEAR(driver.field()[i], u[i], 1e-9);
}

TEST(ForceModelStep, PressBeyondTheDomainIsHeldAndFlagged) {
  const MetaModel& model = forceModel();
  Driver driver(model);
  driver.settle(above(model, -0.002));
  for (double z = -0.002; z < 0.015; z += 1e-4) driver.at(above(model, z));
  const ToolResult& tool = driver.settle(above(model, 0.015));
  EXPECT_EQ(tool.flags, kInContact | kBeyondDomain);
  EXPECT_NEAR(vec(tool.force).norm(), forceOptions().domain_force, 1e-9);
}

TEST(ForceModelStep, WhereTheAnswerIsNoNumberTheForceBeforeIsHeldAndFades) {
  const MetaModel broken = spoiled(forceOptions(), [](modelfile::ModelData& data) {
    std::fill(data.contact_displacement.begin(), data.contact_displacement.end(), 0.0);
  });
  Workspace work(forceModel(), StepConfig{});
  StepInput input;
  StepResult result;
  input.tools[0].present = 1;
  const auto at = [&](const MetaModel& model, double depth) {
    const Vec3 c = above(forceModel(), depth);
    input.tools[0].position = {c.x(), c.y(), c.z()};
    (void)step(model, work, input, result);
    return vec(result.tools[0].force);
  };
  for (double depth = -0.002; depth < 0.002; depth += 1e-4) (void)at(forceModel(), depth);
  Vec3 before = Vec3::Zero();
  for (int i = 0; i < 40; ++i) before = at(forceModel(), 0.002);
  EXPECT_GT(before.norm(), 0.1);
  EXPECT_EQ(at(broken, 0.002), before);
  EXPECT_EQ(result.tools[0].flags & kNonFiniteForce, kNonFiniteForce);
  for (int i = 0; i < 60; ++i) {
    const Vec3 now = at(broken, 0.002);
    EXPECT_LE(now.norm(), before.norm());
    EXPECT_LT((now - before).norm(), 0.1 * 2.0) << "no step";
    before = now;
  }
  EXPECT_EQ(before, Vec3::Zero());
}

TEST(ForceModelStep, BeyondAFoldTheForceStaysAlsoWhenTheToolIsDraggedAside) {
  SyntheticOptions options = forceOptions();
  options.order = 2;
  const MetaModel folded = spoiled(options, fold);
  Driver driver(folded);
  const auto at = [](double depth, double aside) { return Vec3(-0.055 + depth, aside, 0.0); };
  for (double depth = -0.002; depth < 0.003; depth += 5e-5) driver.at(at(depth, 0.0));
  for (double aside = 0.0; aside < 0.004; aside += 5e-5) {
    const ToolResult& tool = driver.at(at(0.003, aside));
    ASSERT_EQ(tool.flags & kNonFiniteForce, 0U) << aside;
    ASSERT_NE(tool.flags & kInContact, 0U) << aside;
    ASSERT_LT(tool.force[0], -0.1) << aside;
  }
}

}  // namespace palpate::testing
