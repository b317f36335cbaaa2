// SPDX-License-Identifier: Apache-2.0
#include "core/tick/step.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "../interpolated.h"
#include "../round_organ.h"
#include "core/response/tool_coupling.h"

namespace palpate::testing {

TEST(Step, FreeToolFeelsNothing) {
  Driver driver(roundOrgan());
  const ToolResult& r = driver.settle(above(-0.002));
  EXPECT_EQ(r.flags, 0U);
  EXPECT_EQ(driver.status(), StepStatus::kOk);
  EXPECT_EQ(vec(r.force), Vec3::Zero());
  ASSERT_FALSE(driver.field().empty());
  for (const float u : driver.field()) ASSERT_EQ(u, 0.0F);
}

TEST(Step, PressIsAnsweredByTheModelsForceOnTheTool) {
  Driver driver(roundOrgan());
  press(driver, 0.002);
  const ToolResult& r = driver.result().tools[0];
  EXPECT_EQ(r.flags, kInContact);
  EXPECT_EQ(r.state, static_cast<std::uint32_t>(ContactState::kStick));
  const NearestPoint top = roundOrgan().surface().closestPoint(Vec3(0.0, 0.0, 1.0));
  EXPECT_LT((vec(r.anchor) - top.position).norm(), 1e-9);
  EXPECT_LT((vec(r.displacement) - Vec3(0.0, 0.0, -0.002)).norm(), 1e-12);
  EXPECT_NEAR(r.penetration, 0.002, 1e-4);
  Response response;
  ASSERT_EQ(respond(roundOrgan(), top.s, Vec3(0.0, 0.0, -0.002), response), ResponseStatus::kOk);
  EXPECT_LT((vec(r.force) + response.force).norm(), 1e-9);
  EXPECT_GT(r.force[2], 0.5);
}

TEST(Step, ProxyIsTheDeformedSurfaceAtTheAnchor) {
  Driver driver(roundOrgan());
  press(driver, 0.003);
  const ToolResult& r = driver.result().tools[0];
  const NearestPoint top = roundOrgan().surface().closestPoint(Vec3(0.0, 0.0, 1.0));
  FieldScratch scratch(roundOrgan());
  std::vector<float> u(driver.field().size());
  evaluateField(roundOrgan(), top.s, vec(r.displacement), scratch, u);
  EXPECT_LT((vec(r.proxy) - vec(r.anchor) - interpolated(roundOrgan().surface(), u, top.s)).norm(), 1e-7);
  EXPECT_LT(r.proxy[2], r.anchor[2]);
}

TEST(Step, StiffnessIsTheSlopeOfTheRenderedForce) {
  for (const double limit : {3.3, 0.3}) {  // the second one cuts the force
    StepConfig config;
    config.force_limit = limit;
    for (const double depth : {0.002, 0.009}) {  // the second one lies beyond the domain
      Driver driver(roundOrgan(), config);
      press(driver, depth);
      const Vec3 c = above(depth) + Vec3(2e-4, -1e-4, 0.0);
      const ToolResult here = driver.settle(c);
      for (int j = 0; j < 3; ++j) {
        const double h = 1e-7;
        const Vec3 plus = vec(driver.at(c + h * Vec3::Unit(j)).force);
        const Vec3 minus = vec(driver.at(c - h * Vec3::Unit(j)).force);
        for (std::size_t i = 0; i < 3; ++i)
          EXPECT_NEAR(here.stiffness[3 * i + static_cast<std::size_t>(j)],
                      (plus - minus)[static_cast<Eigen::Index>(i)] / (2.0 * h), 2e-3)
              << "limit " << limit << " depth " << depth;
      }
    }
  }
}

TEST(Step, FarBeyondTheDomainIsClampedAndFlagged) {
  Driver driver(roundOrgan());
  press(driver, 0.02);
  const ToolResult& r = driver.result().tools[0];
  EXPECT_EQ(r.flags & kBeyondDomain, kBeyondDomain);
  EXPECT_NEAR(vec(r.displacement).norm(), kShownRadii * r.domain_radius, 1e-12);  // here d_max is r_max
  EXPECT_GT(r.penetration, 0.019);
  EXPECT_EQ(driver.status(), StepStatus::kFlagged);
}

TEST(Step, LiftedToolIsReleasedAndCapturedAgainElsewhere) {
  Driver driver(roundOrgan());
  press(driver, 0.003);
  const Vec3 first = vec(driver.result().tools[0].anchor);
  EXPECT_EQ(driver.settle(above(-0.004)).state, 0U);
  EXPECT_EQ(vec(driver.result().tools[0].force).norm(), 0.0);
  EXPECT_EQ(driver.result().tools[0].flags, 0U);
  const Vec3 side = Vec3(0.051, 0.0, 0.01);
  driver.settle(Vec3(0.07, 0.0, 0.01));
  const ToolResult& r = driver.settle(side);
  EXPECT_EQ(r.state, 1U);
  EXPECT_GT((vec(r.anchor) - first).norm(), 0.03);
  EXPECT_GT(r.force[0], 0.0);
}

TEST(Step, ToolDrawnOffSidewaysIsLetGo) {
  Driver driver(roundOrgan());
  press(driver, 0.002);
  Vec3 last = vec(driver.result().tools[0].force);
  ASSERT_GT(last.norm(), 0.5);
  int released = 0;
  for (int ms = 0; ms < 800; ++ms) {
    const ToolResult& r = driver.at(above(0.002) + Vec3(1e-4 * ms, 0.0, 0.0));
    ASSERT_LE((vec(r.force) - last).norm(), 0.15) << ms << " ms: a step in the force";
    last = vec(r.force);
    released += r.state == static_cast<std::uint32_t>(ContactState::kFree) ? 1 : 0;
  }
  EXPECT_GT(released, 60);
  EXPECT_EQ(last, Vec3::Zero());
  EXPECT_EQ(driver.result().tools[0].flags, 0U);
}

TEST(Step, FixedPartHasNoForceAndAFlag) {
  Driver driver(roundOrgan());
  const ToolResult& r = driver.settle(Vec3(0.0, 0.0, -0.05));
  EXPECT_EQ(r.flags, kNotAccessible);
  EXPECT_EQ(vec(r.force), Vec3::Zero());
}

TEST(Step, ToolThatAppearsInsideIsNotKicked) {
  Driver driver(roundOrgan());
  const ToolResult& first = driver.at(above(0.004));
  EXPECT_LT(vec(first.force).norm(), 0.1);
  EXPECT_GT(vec(driver.settle(above(0.004)).force).norm(), 1.0);
}

TEST(Step, TwoToolsFeelEachOtherAsTheModelSays) {
  const auto place = [](StepInput& input, std::size_t i, const Vec3& c) {
    input.tools[i].present = 1;
    input.tools[i].position = {c.x(), c.y(), c.z()};
  };
  const Vec3 top = above(0.003), side(0.052, 0.0, 0.0);
  Driver first(roundOrgan()), second(roundOrgan()), both(roundOrgan());
  place(first.input(), 0, top);
  place(second.input(), 3, side);
  place(both.input(), 0, top);
  place(both.input(), 3, side);
  for (int i = 0; i < 40; ++i) first.tick(), second.tick(), both.tick();
  ASSERT_NE(both.result().tools[0].state, 0U);
  ASSERT_NE(both.result().tools[3].state, 0U);
  const auto anchorOf = [](const ToolResult& r) {
    return roundOrgan().surface().closestPoint(vec(r.anchor)).s;
  };
  const std::array<ContactPoint, 2> s{anchorOf(both.result().tools[0]), anchorOf(both.result().tools[3])};
  const std::array<Vec3, 2> d{vec(both.result().tools[0].displacement),
                              vec(both.result().tools[3].displacement)};
  std::array<Vec3, 2> own;
  Touches touches(roundOrgan());
  ownDisplacements(roundOrgan(), s, d, touches, own);
  for (std::size_t i = 0; i < 2; ++i) {
    Response response;
    (void)respond(roundOrgan(), s[i], d[i], response);
    const Vec3 f = response.force + response.stiffness * (own[i] - d[i]);
    EXPECT_LT((f + vec(both.result().tools[3 * i].force)).norm(), 1e-3 * f.norm());
  }
  EXPECT_GT((vec(both.result().tools[0].force) - vec(first.result().tools[0].force)).norm(), 1e-4);
}

}  // namespace palpate::testing
