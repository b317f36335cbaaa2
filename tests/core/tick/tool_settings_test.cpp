// SPDX-License-Identifier: Apache-2.0
// Tools that differ: each has its own limits, friction, coupling and tip; E is the organ's.
#include <gtest/gtest.h>

#include "../round_organ.h"

namespace palpate::testing {

namespace {

/// Touch at tool 0, something weaker with a smaller tip at tool 1.
StepConfig twoTools() {
  StepConfig config;
  config.own[1] = ToolSettings{0.003, liveParameters(config)};
  config.own[1]->live.force_limit = 0.2;
  config.own[1]->live.youngs_modulus = 1.0;
  return config;
}

void put(Driver& driver, std::size_t tool, const Vec3& c) {
  driver.input().tools[tool].present = 1;
  driver.input().tools[tool].position = {c.x(), c.y(), c.z()};
}

}  // namespace

TEST(ToolSettings, EachToolHasItsOwnForceLimitAndTip) {
  Driver driver(roundOrgan(), twoTools());
  for (double depth = -0.001; depth < 0.003; depth += 5e-5) {
    put(driver, 0, over(0.0, depth));
    put(driver, 1, over(0.9, depth));
    driver.tick();
  }
  for (int i = 0; i < 100; ++i) driver.tick();
  const StepResult& result = driver.result();
  EXPECT_GT(vec(result.tools[0].force).norm(), 0.4);
  EXPECT_NEAR(vec(result.tools[1].force).norm(), 0.2, 1e-9);
  EXPECT_NE(result.tools[1].flags & kForceLimited, 0U);
  EXPECT_NEAR(result.tools[0].penetration - result.tools[1].penetration, 0.002, 1e-4) << "5 mm and 3 mm";
}

TEST(ToolSettings, EIsTheOrgansWhateverAToolSays) {
  const Driver driver(roundOrgan(), twoTools());
  EXPECT_EQ(driver.work().live(1).youngs_modulus, roundOrgan().attributes().E);
}

TEST(ToolSettings, AChangeOfOneToolLeavesTheOtherAsItIs) {
  Driver driver(roundOrgan(), twoTools());
  driver.input().settings = toolSettings(twoTools());
  driver.input().settings[1].live.friction = 0.1;
  driver.input().has_settings = 1;
  for (int i = 0; i < 200; ++i) driver.tick();
  EXPECT_EQ(driver.work().live(0).friction, 0.3);
  EXPECT_EQ(driver.work().live(1).friction, 0.1);
}

TEST(ToolSettings, ATipIsExchangedOnceItsToolTouchesNothing) {
  Driver driver(roundOrgan());
  for (double depth = -0.001; depth < 0.002; depth += 5e-5) driver.at(above(depth));
  const double before = driver.settle(above(0.002)).penetration;
  driver.input().settings = toolSettings(StepConfig{});
  driver.input().settings[0].tip_radius = 0.002;
  driver.input().has_settings = 1;
  EXPECT_EQ(driver.settle(above(0.002)).penetration, before);
  for (double depth = 0.002; depth > -0.003; depth -= 5e-5) driver.at(above(depth));
  for (double depth = -0.003; depth < 0.005; depth += 5e-5) driver.at(above(depth));
  EXPECT_NEAR(driver.settle(above(0.005)).penetration, before, 1e-4) << "3 mm deeper with 3 mm less";
}

TEST(ToolSettings, OneOutOfRangeIsRefusedByToolAndField) {
  StepConfig config = twoTools();
  config.own[1]->live.friction = 3.0;
  const auto complaint = firstComplaint(config);
  ASSERT_TRUE(complaint.has_value());
  EXPECT_EQ(complaint->field, "1.friction");
  EXPECT_THROW(Workspace(roundOrgan(), config), std::invalid_argument);
}

}  // namespace palpate::testing
