// SPDX-License-Identifier: Apache-2.0
#include "palpate/core/step.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include "driver.h"
#include "palpate/core/tool_coupling.h"
#include "palpate/modelfile/model_file.h"

namespace palpate::testing {

namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kTip = 0.005;  // StepConfig's default tip radius, m

/// One organ for all tests here.
const MetaModel& organ() {
  static const MetaModel model = loadSynthetic();
  return model;
}

/// Tip centre that presses `depth` deep into the top of the organ.
Vec3 above(double depth) {
  const NearestPoint top = organ().surface().closestPoint(Vec3(0.0, 0.0, 1.0));
  return top.position + Vec3(0.0, 0.0, kTip - depth);
}

/// Goes down to a depth at 0.1 m/s and waits there.
void press(Driver& driver, double depth) {
  driver.settle(above(-0.002));
  for (double z = -0.002; z < depth; z += 1e-4) driver.at(above(z));
  driver.settle(above(depth));
}

bool isFinite(const ToolResult& r) {
  return vec(r.force).allFinite() && vec(r.proxy).allFinite() && vec(r.anchor).allFinite() &&
         std::isfinite(r.stiffness[0] + r.stiffness[4] + r.stiffness[8]);
}

}  // namespace

TEST(Step, FreeToolFeelsNothing) {
  Driver driver(organ());
  const ToolResult& r = driver.settle(above(-0.002));
  EXPECT_EQ(r.flags, 0U);
  EXPECT_EQ(driver.status(), StepStatus::kOk);
  EXPECT_EQ(vec(r.force), Vec3::Zero());
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

TEST(Step, ForceStaysWithinTheLimitAndKeepsItsDirection) {
  StepConfig config;
  config.force_limit = 0.5;
  Driver driver(organ(), config), free(organ());
  press(driver, 0.004);
  press(free, 0.004);
  const ToolResult& r = driver.result().tools[0];
  EXPECT_EQ(r.flags & kForceLimited, kForceLimited);
  EXPECT_NEAR(vec(r.force).norm(), 0.5, 1e-12);
  EXPECT_LT(vec(r.force).normalized().cross(vec(free.result().tools[0].force).normalized()).norm(), 1e-9);
}

TEST(Step, StalePoseRampsToZeroWithinFiftyMilliseconds) {
  Driver driver(organ());
  press(driver, 0.003);
  const double full = vec(driver.result().tools[0].force).norm();
  double last = full;
  for (std::int64_t ms = 1; ms <= 60; ++ms) {
    const ToolResult& r = driver.at(above(0.003), ms * 1'000'000);
    const double size = vec(r.force).norm();
    EXPECT_LE(std::abs(size - last), full / 25.0) << ms << " ms: a step in the force";
    EXPECT_LE(size, last + 1e-12);
    EXPECT_EQ((r.flags & kStalePose) != 0, ms > 20) << ms << " ms";
    if (ms >= 50) {
      EXPECT_EQ(size, 0.0);
    }
    last = size;
  }
  EXPECT_EQ(driver.result().tools[0].state, 0U);
}

TEST(Step, RampEndsInTimeAtALowRateToo) {
  Driver driver(organ());
  press(driver, 0.003);
  driver.input().dt_ns = 25'000'000;
  driver.at(above(0.003), 25'000'000);
  EXPECT_EQ(vec(driver.at(above(0.003), 50'000'000).force).norm(), 0.0);
}

TEST(Step, ForceIsContinuousWhenAStalePoseComesBack) {
  for (const int silent : {30, 45, 80}) {
    for (const Vec3& back :
         {above(0.003), above(0.006), Vec3(above(0.004) + Vec3(0.003, 0.0, 0.0)), above(-0.01)}) {
      Driver driver(organ());
      press(driver, 0.003);
      for (int ms = 1; ms <= silent; ++ms) driver.at(above(0.003), ms * 1'000'000LL);
      Vec3 last = vec(driver.result().tools[0].force);
      for (int ms = 0; ms < 60; ++ms) {
        const Vec3 now = vec(driver.at(back).force);
        ASSERT_LE((now - last).norm(), 0.15) << silent << " ms silent, " << ms << " ms back";
        last = now;
      }
    }
  }
}

TEST(Step, NonFinitePoseIsNeverPassedOn) {
  Driver driver(organ());
  press(driver, 0.003);
  const Vec3 before = vec(driver.result().tools[0].force);
  for (int ms = 1; ms <= 60; ++ms) {
    for (double bad : {kNaN, std::numeric_limits<double>::infinity(), -1e300}) {
      driver.input().dt_ns = 333'333;
      const ToolResult& r = driver.at(Vec3(0.0, bad, 0.0));
      ASSERT_TRUE(isFinite(r));
      ASSERT_EQ(r.flags & kNonFinitePose, kNonFinitePose);
      if (ms < 18) {
        ASSERT_LT((vec(r.force) - before).norm(), 1e-12) << "a short glitch is held";
      }
      if (ms > 50) {
        ASSERT_EQ(vec(r.force).norm(), 0.0);
      }
    }
  }
  driver.input().dt_ns = 1'000'000;
  EXPECT_LT((vec(driver.settle(above(0.003)).force) - before).norm(), 1e-9) << "it recovers";
}

TEST(Step, NonUnitQuaternionIsAnsweredLikeAStalePose) {
  Driver driver(organ());
  press(driver, 0.003);
  for (const std::array<double, 4>& bad :
       {std::array{0.0, 0.0, 0.0, 0.0}, std::array{0.0, 0.0, 0.0, 1.5}, std::array{kNaN, 0.0, 0.0, 1.0}}) {
    driver.input().tools[0].orientation = bad;
    const ToolResult& r = driver.at(above(0.003));
    EXPECT_NE(r.flags & (kNonUnitQuaternion | kNonFinitePose), 0U);
    EXPECT_TRUE(isFinite(r));
  }
  for (int ms = 0; ms < 60; ++ms) driver.at(above(0.003));
  EXPECT_EQ(vec(driver.result().tools[0].force).norm(), 0.0);
  EXPECT_EQ(driver.result().tools[0].flags & kStalePose, kStalePose);
}

TEST(Step, OverflowInTheModelNeverComesOut) {
  modelfile::ModelData data = syntheticModel();
  for (double& f : data.contact_force) f *= 1e306;
  for (float& u : data.near_field) u = 3e38F;
  const TemporaryFile file("overflow.h5");
  modelfile::writeModel(file.path(), data);
  const MetaModel model = MetaModel::load(file.path());
  Driver driver(model);
  press(driver, 0.004);
  EXPECT_TRUE(isFinite(driver.result().tools[0]));
  EXPECT_EQ(driver.result().tools[0].flags & kNonFiniteForce, kNonFiniteForce);
  for (const float u : driver.work().displacement()) ASSERT_TRUE(std::isfinite(u));
}

TEST(Step, OverflowInTheFieldAloneLeavesTheForceAndShowsNoField) {
  modelfile::ModelData data = syntheticModel();
  for (float& x : data.modes_X) x *= 1e30F;
  for (float& y : data.modes_Y) y *= 1e30F;
  const TemporaryFile file("field-overflow.h5");
  modelfile::writeModel(file.path(), data);
  const MetaModel model = MetaModel::load(file.path());
  Driver driver(model), sound(organ());
  press(driver, 0.004);
  press(sound, 0.004);
  EXPECT_EQ(driver.result().tools[0].flags, kInContact | kNonFiniteForce);
  EXPECT_EQ(driver.result().tools[0].force, sound.result().tools[0].force);
  EXPECT_EQ(driver.status(), StepStatus::kFlagged);
  for (const float u : driver.work().displacement()) ASSERT_EQ(u, 0.0F);
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

TEST(Step, ShutdownFadesToZeroForGood) {
  Driver driver(organ());
  press(driver, 0.003);
  const double full = vec(driver.result().tools[0].force).norm();
  driver.input().shutting_down = 1;
  double last = full;
  for (int ms = 0; ms < 40; ++ms) {
    const ToolResult& r = driver.at(above(0.003 + 1e-4 * ms));
    EXPECT_EQ(r.flags & kShuttingDown, kShuttingDown);
    EXPECT_LE(vec(r.force).norm(), last);
    EXPECT_GE(vec(r.force).norm(), last - full / 25.0);
    last = vec(r.force).norm();
  }
  EXPECT_EQ(last, 0.0);
}

TEST(Step, ToolThatIsGoneIsForgotten) {
  Driver driver(organ());
  press(driver, 0.003);
  driver.input().tools[0].present = 0;
  driver.tick();
  EXPECT_GT(vec(driver.result().tools[0].force).norm(), 0.5) << "held first";
  for (int ms = 0; ms < 60; ++ms) driver.tick();
  EXPECT_EQ(driver.result().tools[0].flags, 0U);
  EXPECT_EQ(vec(driver.result().tools[0].force), Vec3::Zero());
}

}  // namespace palpate::testing
