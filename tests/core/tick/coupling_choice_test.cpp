// SPDX-License-Identifier: Apache-2.0
// The default coupling follows the organ's stiffness and the device.
#include "core/tick/coupling_choice.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "../round_organ.h"
#include "core/response/largest_stiffness.h"
#include "core/tick/apply_preset.h"

namespace palpate::testing {

namespace {

const DevicePreset kTouch = *findDevicePreset("touch");

double organStiffness() {
  static const double found = largestStiffness(roundOrgan());
  return found;
}

/// E at which the round organ has that K_max, Pa.
double modulusFor(double K) {
  return roundOrgan().attributes().E * K / organStiffness();
}

/// A touch on an organ of that K_max, without what blends and bounds forces.
StepConfig touchOn(double K) {
  StepConfig config = bare(kInfinity);
  const double force_limit = config.force_limit;
  apply(kTouch, config);
  config.force_limit = force_limit;
  config.organ_stiffness = organStiffness();
  config.youngs_modulus = modulusFor(K);
  return config;
}

/// |force| at rest at this depth, N.
double forceAt(const StepConfig& config, double depth) {
  Driver driver(roundOrgan(), config);
  for (double z = -0.001; z < depth; z += 5e-5) driver.at(above(z));
  return vec(driver.settle(above(depth)).force).norm();
}

/// |d force / d pose| along the normal, N/m, at a depth at which the organ is near its stiffness at rest.
double renderedAt(const StepConfig& config) {
  return (forceAt(config, 0.0012) - forceAt(config, 0.0008)) / 0.0004;
}

}  // namespace

TEST(CouplingChoice, IsNoneWhereTheDeviceRendersTheOrgan) {
  for (const double K : {1.0, 130.0, 299.9, 300.0})
    EXPECT_EQ(couplingCompliance(0.0, 1.0 / 300.0, {5e3, K}, 5e3), 0.0) << K;
  EXPECT_EQ(couplingCompliance(0.0, 1.0 / 300.0, {160e3, 4200.0}, 5e3), 0.0) << "at 5 kPa it has 131 N/m";
}

TEST(CouplingChoice, GivesTheSeriesWhatTheDeviceRendersOnAStifferOrgan) {
  for (const double E : {12e3, 20e3, 160e3, 1e6}) {
    const double K = 4200.0 * E / 160e3;
    const double compliance = couplingCompliance(0.0, 1.0 / 300.0, {160e3, 4200.0}, E);
    EXPECT_NEAR(1.0 / (compliance + 1.0 / K), 300.0, 1e-9) << E;
  }
  EXPECT_NEAR(1.0 / couplingCompliance(0.0, 1.0 / 300.0, {160e3, kInfinity}, 5e3), 300.0, 1e-9)
      << "as of a rigid organ";
}

TEST(CouplingChoice, ASofterOneThatIsAskedForHolds) {
  EXPECT_EQ(couplingCompliance(0.01, 1.0 / 300.0, {160e3, 4200.0}, 160e3), 0.01);
  EXPECT_EQ(couplingCompliance(0.01, 1.0 / 300.0, {160e3, 4200.0}, 5e3), 0.01);
  EXPECT_EQ(couplingCompliance(0.0, 0.0, {160e3, 4200.0}, 1e9), 0.0) << "custom";
}

TEST(CouplingChoice, ATouchGivesTheHandAllOfASoftOrgan) {
  const StepConfig touch = touchOn(130.0);
  StepConfig model = touch, before = touch;
  model.rendered_stiffness = kInfinity;
  before.coupling_stiffness = 300.0;
  const double own = forceAt(model, 0.005);
  EXPECT_GT(own, 0.3);
  EXPECT_GE(forceAt(touch, 0.005), 0.999 * own);
  EXPECT_LT(forceAt(before, 0.005), 0.9 * own) << "a coupling of 300 N/m would hide more than a tenth";
}

TEST(CouplingChoice, AStiffOrganIsRenderedAtThreeQuartersOfTheDevicesLimit) {
  for (const double K : {600.0, 4200.0, 1e5}) {
    const double rendered = renderedAt(touchOn(K));
    EXPECT_LE(rendered, 300.0 * (1.0 + 1e-6)) << K;
    EXPECT_GE(rendered, 0.75 * 300.0) << K << ": K_max is met under load, this is near rest";
  }
}

TEST(CouplingChoice, FollowsLiveEWithoutAStep) {
  for (const auto& [from, to] :
       {std::pair(130.0, 4200.0), std::pair(4200.0, 130.0), std::pair(150.0, 600.0)}) {
    StepConfig config = touchOn(from);
    Driver driver(roundOrgan(), config);
    for (double z = -0.001; z < 0.003; z += 5e-5) driver.at(above(z));
    const Vec3 first = vec(driver.settle(above(0.003)).force);
    config.youngs_modulus = modulusFor(to);
    driver.input().has_settings = 1;
    driver.input().settings = toolSettings(config);
    Vec3 last = first;
    double steepest = 0.0;
    for (int ms = 0; ms < 200; ++ms) {
      const ToolResult& result = driver.at(above(0.003));
      EXPECT_EQ(result.flags & kRamping, 0U) << "nothing to blend over";
      const Vec3 now = vec(result.force);
      steepest = std::max(steepest, (now - last).norm());
      last = now;
      const LiveParameters& live = driver.work().live();
      const double K = organStiffness() * live.youngs_modulus / roundOrgan().attributes().E;
      EXPECT_LE(1.0 / (1.0 / live.coupling_stiffness + 1.0 / K), 300.0 * (1.0 + 1e-9));
    }
    EXPECT_NEAR(last.norm(), forceAt(config, 0.003), 1e-6);
    EXPECT_LE(steepest, 0.08 * (last - first).norm()) << from << " to " << to << " N/m";
  }
}

TEST(CouplingChoice, IsBlendedOverWhenADeviceComes) {
  StepConfig config = touchOn(4200.0);
  config.rendered_stiffness = kInfinity;
  config.ramp_time = StepConfig{}.ramp_time;
  Driver driver(roundOrgan(), config);
  for (double z = -0.001; z < 0.003; z += 5e-5) driver.at(above(z));
  const Vec3 first = vec(driver.settle(above(0.003)).force);
  config.rendered_stiffness = kTouch.rendered_stiffness;
  driver.input().has_settings = 1;
  driver.input().settings = toolSettings(config);
  Vec3 last = first;
  double steepest = 0.0;
  for (int ms = 0; ms < 200; ++ms) {
    const Vec3 now = vec(driver.at(above(0.003)).force);
    steepest = std::max(steepest, (now - last).norm());
    last = now;
  }
  EXPECT_LT(last.norm(), 0.2 * first.norm());
  EXPECT_LE(steepest, 0.05 * (last - first).norm());
}

}  // namespace palpate::testing
