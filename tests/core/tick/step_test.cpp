// SPDX-License-Identifier: Apache-2.0
#include "core/tick/step.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include "../round_organ.h"
#include "core/response/tool_coupling.h"

namespace palpate::testing {

namespace {

/// One organ for all tests here.
const MetaModel& organ() {
  return roundOrgan();
}

}  // namespace

TEST(Step, FreeToolFeelsNothing) {
  Driver driver(organ());
  const ToolResult& r = driver.settle(above(-0.002));
  EXPECT_EQ(r.flags, 0U);
  EXPECT_EQ(driver.status(), StepStatus::kOk);
  EXPECT_EQ(vec(r.force), Vec3::Zero());
  ASSERT_FALSE(driver.work().displacement().empty());
  for (const float u : driver.work().displacement()) ASSERT_EQ(u, 0.0F);
}

TEST(Step, PressIsAnsweredByTheModelsForceOnTheTool) {
  Driver driver(organ());
  press(driver, 0.002);
  const ToolResult& r = driver.result().tools[0];
  EXPECT_EQ(r.flags, kInContact);
  EXPECT_EQ(r.state, static_cast<std::uint32_t>(ContactState::kStick));
  const NearestPoint top = organ().surface().closestPoint(Vec3(0.0, 0.0, 1.0));
  EXPECT_LT((vec(r.anchor) - top.position).norm(), 1e-9);
  EXPECT_LT((vec(r.displacement) - Vec3(0.0, 0.0, -0.002)).norm(), 1e-12);
  EXPECT_NEAR(r.penetration, 0.002, 1e-4);
  Response response;
  ASSERT_EQ(respond(organ(), top.s, Vec3(0.0, 0.0, -0.002), response), ResponseStatus::kOk);
  EXPECT_LT((vec(r.force) + response.force).norm(), 1e-9);
  EXPECT_GT(r.force[2], 0.5);
}

TEST(Step, ProxyIsTheDeformedSurfaceAtTheAnchor) {
  Driver driver(organ());
  press(driver, 0.003);
  const ToolResult& r = driver.result().tools[0];
  const NearestPoint top = organ().surface().closestPoint(Vec3(0.0, 0.0, 1.0));
  FieldScratch scratch(organ());
  std::vector<float> u(driver.work().displacement().size());
  evaluateField(organ(), top.s, vec(r.displacement), scratch, u);
  EXPECT_LT((vec(r.proxy) - vec(r.anchor) - organ().surface().interpolate(u, top.s)).norm(), 1e-7);
  EXPECT_LT(r.proxy[2], r.anchor[2]);
}

// One tick in seven is shown; two tools, one of which slides, comes and goes.
TEST(Step, ASurfaceThatNobodyTakesChangesNoAnswer) {
  StepConfig config;
  config.friction = 0.1;
  Driver every(organ(), config), seldom(organ(), config);
  int compared = 0;
  const auto play = [&](const Vec3& first, const Vec3& second, bool taken) {
    for (Driver* driver : {&every, &seldom}) {
      ToolInput& tool = driver->input().tools[1];
      tool.present = 1;
      tool.position = {second.x(), second.y(), second.z()};
      driver->input().skip_surface = driver == &seldom && !taken ? 1 : 0;
      driver->at(first);
    }
    const bool jumped = ((every.result().tools[0].flags | every.result().tools[1].flags) & kRamping) != 0;
    for (std::size_t i = 0; i < 2; ++i) {
      const ToolResult &a = every.result().tools[i], &b = seldom.result().tools[i];
      ASSERT_EQ(a.flags, b.flags);
      ASSERT_EQ(a.force, b.force);
      ASSERT_EQ(a.anchor, b.anchor);
      ASSERT_LT((vec(a.proxy) - vec(b.proxy)).norm(), jumped ? 1e-4 : 1e-9) << "tool " << i;
      const ContactPoint here = organ().surface().closestPoint(vec(a.anchor)).s;
      const Vec3 shown = organ().surface().interpolate(every.work().displacement(), here);
      ASSERT_LT((vec(a.proxy) - vec(a.anchor) - shown).norm(), 1e-6)
          << "tool " << i << ": the proxy is on the surface";
      compared += !jumped && vec(a.proxy) != vec(a.anchor) ? 1 : 0;
    }
    if (taken && !jumped) {
      ASSERT_TRUE(std::ranges::equal(every.work().displacement(), seldom.work().displacement()));
    }
  };
  for (int i = 0; i < 700; ++i) {
    const double t = 1e-3 * i;
    const Vec3 second = above(0.002 * std::sin(20.0 * t)) + Vec3(0.01 * t, 0.02, -0.004);
    play(above(0.003 * std::min(1.0, 5.0 * t)) + Vec3(0.01 * t, 0.0, 0.0), second, i % 7 == 0);
    if (HasFatalFailure()) return;
  }
  EXPECT_GT(compared, 700) << "the tools were in contact, and not always in a jump";
}

TEST(Step, ASurfaceThatNobodyTakesStaysAsItWas) {
  Driver driver(organ());
  press(driver, 0.002);
  const std::span<const float> shown = driver.work().displacement();
  const std::vector<float> before(shown.begin(), shown.end());
  driver.input().skip_surface = 1;
  for (int i = 0; i < 20; ++i) driver.at(above(0.002 + 1e-4 * i));
  EXPECT_TRUE(std::ranges::equal(shown, before));
  driver.input().skip_surface = 0;
  driver.settle(above(0.004));
  EXPECT_FALSE(std::ranges::equal(shown, before));
}

// A canary in the field while forces are found: what the jump blends from is read where the tool is, and nowhere else.
TEST(Step, AForceThatJumpsDoesNotTouchTheField) {
  Driver driver(organ());
  press(driver, 0.002);
  const std::span<const float> shown = driver.work().displacement();
  const std::vector<float> before(shown.begin(), shown.end());
  const auto overwrite = [&](float number) {
    float* const field = const_cast<float*>(shown.data());
    for (std::size_t i = 0; i < shown.size(); ++i) field[i] = number == 0.0F ? before[i] : number;
  };
  driver.input().skip_surface = 1;
  overwrite(1000.0F);
  driver.at(Vec3(0.2, 0.0, 0.0));
  ASSERT_NE(driver.result().tools[0].flags & kPoseJump, 0U);
  EXPECT_TRUE(std::ranges::all_of(shown, [](float u) { return u == 1000.0F; })) << "written";
  overwrite(0.0F);
  driver.input().skip_surface = 0;
  driver.at(Vec3(0.2, 0.0, 0.0));
  EXPECT_LT(*std::ranges::max_element(shown), 0.01F) << "read";
}

TEST(Step, ASurfaceBlendsFromTheLastOneThatWasShown) {
  const Vec3 away(0.2, 0.0, 0.0);
  Driver driver(organ());
  press(driver, 0.002);
  const std::span<const float> shown = driver.work().displacement();
  const std::vector<float> before(shown.begin(), shown.end());
  driver.input().skip_surface = 1;
  for (int ms = 0; ms < 5; ++ms) driver.at(away);
  driver.input().skip_surface = 0;
  driver.at(away);
  for (std::size_t i = 0; i < shown.size(); ++i) ASSERT_NEAR(shown[i], before[i] * 24.0F / 30.0F, 1e-7F);
}

TEST(Step, NothingBlendsFromASurfaceThatWasShownLongAgo) {
  Driver driver(organ());
  press(driver, 0.004);
  const Vec3 deep = vec(driver.result().tools[0].proxy) - vec(driver.result().tools[0].anchor);
  driver.input().skip_surface = 1;
  for (double depth = 0.004; depth > -0.002; depth -= 1e-4) driver.at(above(depth));
  driver.settle(above(-0.002));
  driver.at(above(0.0015));  // a capture that is deep at once
  ASSERT_NE(driver.result().tools[0].flags & kRamping, 0U);
  const Vec3 dent = vec(driver.result().tools[0].proxy) - vec(driver.result().tools[0].anchor);
  EXPECT_LT(dent.norm(), 0.6 * deep.norm());
}

TEST(Step, StiffnessIsTheSlopeOfTheRenderedForce) {
  for (const double limit : {3.3, 0.3}) {  // the second one cuts the force
    StepConfig config;
    config.force_limit = limit;
    for (const double depth : {0.002, 0.009}) {  // the second one lies beyond the domain
      Driver driver(organ(), config);
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

TEST(Step, BeyondTheDomainIsClampedAndFlagged) {
  Driver driver(organ());
  press(driver, 0.012);
  const ToolResult& r = driver.result().tools[0];
  EXPECT_EQ(r.flags & kBeyondDomain, kBeyondDomain);
  EXPECT_NEAR(vec(r.displacement).norm(), r.domain_radius, 1e-12);
  EXPECT_GT(r.penetration, 0.011);
  EXPECT_EQ(driver.status(), StepStatus::kFlagged);
}

/// Largest step of a component of the field in one tick.
float stepOf(const Driver& driver, std::vector<float>& last) {
  float most = 0.0F;
  const std::span<const float> now = driver.work().displacement();
  for (std::size_t i = 0; i < now.size(); ++i) most = std::max(most, std::abs(now[i] - last[i]));
  last.assign(now.begin(), now.end());
  return most;
}

TEST(Step, FieldIsContinuousWhenAContactJumps) {
  Driver driver(organ());
  std::vector<float> last(driver.work().displacement().size());
  const auto play = [&](const Vec3& c, int ticks, std::int64_t age_ns, const char* what) {
    for (int ms = 0; ms < ticks; ++ms) {
      driver.at(c, age_ns);
      ASSERT_LE(stepOf(driver, last), 2e-4F) << what << ", " << ms << " ms";
    }
  };
  ASSERT_NO_FATAL_FAILURE(play(above(0.004), 50, 0, "appears inside"));
  EXPECT_LT(*std::min_element(last.begin(), last.end()), -0.001F);
  ASSERT_NO_FATAL_FAILURE(play(Vec3(0.2, 0.0, 0.0), 10, 0, "gone at once"));
  ASSERT_NO_FATAL_FAILURE(play(Vec3(0.052, 0.0, 0.0), 50, 0, "elsewhere while it still blends"));
  for (std::int64_t ms = 1; ms < 80; ++ms)
    ASSERT_NO_FATAL_FAILURE(play(Vec3(0.052, 0.0, 0.0), 1, ms * 1'000'000, "falls silent"));
  ASSERT_NO_FATAL_FAILURE(play(above(0.004), 50, 0, "comes back"));
}

TEST(Step, LiftedToolIsReleasedAndCapturedAgainElsewhere) {
  Driver driver(organ());
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
  Driver driver(organ());
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
  Driver driver(organ());
  const ToolResult& r = driver.settle(Vec3(0.0, 0.0, -0.05));
  EXPECT_EQ(r.flags, kNotAccessible);
  EXPECT_EQ(vec(r.force), Vec3::Zero());
}

TEST(Step, ToolThatAppearsInsideIsNotKicked) {
  Driver driver(organ());
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
  Driver first(organ()), second(organ()), both(organ());
  place(first.input(), 0, top);
  place(second.input(), 3, side);
  place(both.input(), 0, top);
  place(both.input(), 3, side);
  for (int i = 0; i < 40; ++i) first.tick(), second.tick(), both.tick();
  ASSERT_NE(both.result().tools[0].state, 0U);
  ASSERT_NE(both.result().tools[3].state, 0U);
  const auto anchorOf = [](const ToolResult& r) { return organ().surface().closestPoint(vec(r.anchor)).s; };
  const std::array<ContactPoint, 2> s{anchorOf(both.result().tools[0]), anchorOf(both.result().tools[3])};
  const std::array<Vec3, 2> d{vec(both.result().tools[0].displacement),
                              vec(both.result().tools[3].displacement)};
  std::array<Vec3, 2> own;
  FieldScratch scratch(organ());
  ownDisplacements(organ(), s, d, scratch, own);
  for (std::size_t i = 0; i < 2; ++i) {
    Response response;
    (void)respond(organ(), s[i], d[i], response);
    const Vec3 f = response.force + response.stiffness * (own[i] - d[i]);
    EXPECT_LT((f + vec(both.result().tools[3 * i].force)).norm(), 1e-3 * f.norm());
  }
  EXPECT_GT((vec(both.result().tools[0].force) - vec(first.result().tools[0].force)).norm(), 1e-4);
}

}  // namespace palpate::testing
