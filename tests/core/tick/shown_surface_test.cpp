// SPDX-License-Identifier: Apache-2.0
// The surface that is shown of ticks, taken at a rate of its own, and the proxies that go with it.
#include "core/tick/shown_surface.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "../interpolated.h"
#include "../round_organ.h"

namespace palpate::testing {

namespace {

std::vector<float> copyOf(std::span<const float> field) {
  return {field.begin(), field.end()};
}

/// Of tool 0's proxy, m.
Vec3 dentOf(const ToolResult& r) {
  return vec(r.proxy) - vec(r.anchor);
}

}  // namespace

// One tick in seven is shown; two tools, one of which slides, comes and goes.
TEST(ShownSurface, ThatNobodyTakesChangesNoAnswer) {
  StepConfig config;
  config.friction = 0.1;
  Driver every(roundOrgan(), config), seldom(roundOrgan(), config);
  int compared = 0;
  const auto play = [&](const Vec3& first, const Vec3& second, bool taken) {
    seldom.show(taken);
    for (Driver* driver : {&every, &seldom}) {
      ToolInput& tool = driver->input().tools[1];
      tool.present = 1;
      tool.position = {second.x(), second.y(), second.z()};
      driver->at(first);
    }
    const bool jumped = ((every.result().tools[0].flags | every.result().tools[1].flags) & kRamping) != 0;
    for (std::size_t i = 0; i < 2; ++i) {
      const ToolResult &a = every.result().tools[i], &b = seldom.result().tools[i];
      ASSERT_EQ(a.flags, b.flags);
      ASSERT_EQ(a.force, b.force);
      ASSERT_EQ(a.anchor, b.anchor);
      ASSERT_EQ(a.proxy, b.proxy);
      const ContactPoint here = roundOrgan().surface().closestPoint(vec(a.anchor)).s;
      const Vec3 shown = interpolated(roundOrgan().surface(), every.field(), here);
      const double off = (vec(a.proxy) - vec(a.anchor) - shown).norm();
      ASSERT_LT(off, jumped ? 2e-4 : 2e-5)
          << "tool " << i << ": the proxy is on the surface, of a travel of 3 mm";
      compared += !jumped && vec(a.proxy) != vec(a.anchor) ? 1 : 0;
    }
    if (taken && !jumped) {
      ASSERT_TRUE(std::ranges::equal(every.field(), seldom.field()));
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

TEST(ShownSurface, IsEvaluatedOnlyWhereItChanged) {
  Driver driver(roundOrgan());
  press(driver, 0.002);
  const SurfaceState before = driver.work().surface();
  EXPECT_FALSE(driver.surface().show(before));
  driver.show(false);
  driver.at(above(0.0021));
  EXPECT_TRUE(driver.surface().show(driver.work().surface()));
  EXPECT_FALSE(driver.surface().show(driver.work().surface()));
  EXPECT_TRUE(driver.surface().show(before));
}

TEST(ShownSurface, OfAJumpThatWasNotShownBlendsFromTheLastOneThatWas) {
  const Vec3 away(0.2, 0.0, 0.0);
  Driver driver(roundOrgan());
  press(driver, 0.002);
  const std::vector<float> before = copyOf(driver.field());
  driver.show(false);
  for (int ms = 0; ms < 5; ++ms) driver.at(away);
  driver.show(true);
  driver.at(away);
  const auto shown = driver.field();
  for (std::size_t i = 0; i < shown.size(); ++i) ASSERT_NEAR(shown[i], before[i] * 24.0F / 30.0F, 1e-7F);
}

// Two jumps between two fields: the second one's weight, and all of what was shown before the first.
TEST(ShownSurface, OfTwoJumpsThatWereNotShownBlendsByTheLastOne) {
  Driver driver(roundOrgan());
  press(driver, 0.002);
  const std::vector<float> before = copyOf(driver.field());
  driver.show(false);
  for (int ms = 0; ms < 10; ++ms) driver.at(Vec3(0.2, 0.0, 0.0));
  for (int ms = 0; ms < 5; ++ms) driver.at(Vec3(0.0, 0.2, 0.0));
  driver.at(above(0.001));
  for (int ms = 0; ms < 2; ++ms) driver.at(above(0.001));
  driver.show(true);
  driver.at(above(0.001));
  ShownSurface pure(roundOrgan());
  SurfaceState now = driver.work().surface();
  EXPECT_GE(now.jumps, 2U);
  EXPECT_NEAR(now.blend, 0.9, 0.04);
  const auto weight = static_cast<float>(now.blend);
  now.blend = 0.0;
  (void)pure.show(now);
  const auto shown = driver.field();
  for (std::size_t i = 0; i < shown.size(); ++i)
    ASSERT_NEAR(shown[i], (1.0F - weight) * pure.displacement()[i] + weight * before[i], 1e-8F);
}

TEST(ShownSurface, ThatNobodySawIsNotBlendedFrom) {
  Driver driver(roundOrgan());
  press(driver, 0.002);
  driver.surface().forget();
  driver.at(Vec3(0.2, 0.0, 0.0));
  ASSERT_GT(driver.work().surface().blend, 0.9);
  EXPECT_TRUE(std::ranges::all_of(driver.field(), [](float u) { return u == 0.0F; }));
}

TEST(ShownSurface, ThatIsForgottenWithinABlendGoesOnWithout) {
  Driver driver(roundOrgan());
  press(driver, 0.002);
  driver.at(Vec3(0.2, 0.0, 0.0));
  EXPECT_LT(std::ranges::min(driver.field()), -1e-4F);
  driver.surface().forget();
  driver.at(Vec3(0.2, 0.0, 0.0));
  EXPECT_TRUE(std::ranges::all_of(driver.field(), [](float u) { return u == 0.0F; }));
}

/// Largest step of a component of the field in one tick.
float stepOf(const Driver& driver, std::vector<float>& last) {
  float most = 0.0F;
  const std::span<const float> now = driver.field();
  for (std::size_t i = 0; i < now.size(); ++i) most = std::max(most, std::abs(now[i] - last[i]));
  last = copyOf(now);
  return most;
}

TEST(ShownSurface, IsContinuousWhenAContactJumps) {
  Driver driver(roundOrgan());
  std::vector<float> last(driver.field().size());
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

// Two tools; the other one comes and goes at once, 20 mm beside.
TEST(Proxy, IsContinuousWhenAContactJumps) {
  Driver driver(roundOrgan());
  press(driver, 0.004);
  Vec3 last = vec(driver.result().tools[0].proxy);
  double moved = 0.0;
  const Vec3 side = roundOrgan().surface().closestPoint(Vec3(0.02, 0.0, 0.05)).position * 1.02;
  for (int ms = 0; ms < 200; ++ms) {
    ToolInput& other = driver.input().tools[1];
    other.present = 1;
    const bool there = ms >= 20 && ms < 90;
    const Vec3 c = there ? side : Vec3(0.0, 0.0, 0.2);
    other.position = {c.x(), c.y(), c.z()};
    const Vec3 now = vec(driver.at(above(ms < 150 ? 0.004 : -0.02)).proxy);
    ASSERT_LE((now - last).norm(), 2.5e-4) << ms << " ms";
    moved = std::max(moved, (now - last).norm());
    last = now;
  }
  EXPECT_GT(moved, 5e-5) << "the last one: the tool was taken away at once";
  EXPECT_LT(dentOf(driver.result().tools[0]).norm(), 1e-6);
}

TEST(Proxy, OfAToolThatLeaptElsewhereBeginsOnTheSurfaceThere) {
  Driver driver(roundOrgan());
  press(driver, 0.004);
  ASSERT_GT(dentOf(driver.result().tools[0]).norm(), 0.0015);
  driver.at(Vec3(0.052, 0.0, 0.0));
  ASSERT_NE(driver.result().tools[0].flags & kPoseJump, 0U);
  EXPECT_LT(dentOf(driver.result().tools[0]).norm(), 3e-4);
}

}  // namespace palpate::testing
