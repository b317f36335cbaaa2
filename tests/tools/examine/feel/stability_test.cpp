// SPDX-License-Identifier: Apache-2.0
// The closed loop of palpate-feel coupling: each device in a loose hand presses on organs of 0.1 to 5 N/mm.
#include "tools/examine/feel/stability.h"

#include <gtest/gtest.h>

#include <string>

#include "core/response/largest_stiffness.h"
#include "tools/examine/feel/surface_path.h"
#include "uneven_organ.h"

namespace palpate::testing {

namespace {

constexpr device::Hand kLoose{0.02, 0.5, 50.0};  // kg, N s/m, N/m

/// A press at the top. @param[in] stiffness  of the organ there, along the normal, N/m
feel::StabilityCase pressOn(const DevicePreset& preset, double stiffness) {
  const ContactPoint s = unevenOrgan().surface().closestPoint(Vec3(0.0, 0.0, 0.05)).s;
  const double E = unevenOrgan().attributes().E * stiffness / feel::normalStiffness(unevenOrgan(), s);
  return {preset, E, kLoose, s, largestStiffness(unevenOrgan())};
}

class ClosedLoop : public ::testing::TestWithParam<DevicePreset> {};

}  // namespace

TEST_P(ClosedLoop, IsStableAtTheDefaultCouplingAndBeyondTheDevicesLimit) {
  for (const double stiffness : {100.0, 1e3, 5e3})
    for (const bool friction : {true, false}) {  // of the device: it hides much of what the loop does
      SCOPED_TRACE(::testing::Message() << stiffness << " N/m, friction " << friction);
      feel::StabilityCase which = pressOn(GetParam(), stiffness);
      which.friction = friction;
      const feel::StabilityResult result = feel::stability(unevenOrgan(), which);
      EXPECT_TRUE(result.at_default.stable);
      EXPECT_GT(result.at_default.max_force, 0.05) << "N: the organ was reached";
      EXPECT_GE(result.largest_stable, GetParam().stiffness_limit);
      if (friction) {
        EXPECT_EQ(result.largest_stable, feel::kStiffestCoupling) << "the search goes beyond the limit";
      }
    }
}

INSTANTIATE_TEST_SUITE_P(Presets, ClosedLoop,
                         ::testing::ValuesIn(devicePresets().begin(), devicePresets().end()),
                         [](const auto& row) { return std::string(row.param.name); });

TEST(ClosedLoopOfAStiffCoupling, BuzzesWithoutTheDevicesFriction) {
  constexpr double kStiff = 1e4;  // N/m, ten times what the stiffest device renders
  for (const DevicePreset& preset : devicePresets()) {
    if (preset.name == "premium30") continue;  // heavier and more damped, it takes even that
    feel::StabilityCase which = pressOn(preset, 5e3);
    which.friction = false;
    EXPECT_FALSE(feel::press(unevenOrgan(), which, kStiff).stable) << preset.name;
    EXPECT_LT(feel::stability(unevenOrgan(), which).largest_stable, kStiff)
        << preset.name << ": the search found it";
  }
}

}  // namespace palpate::testing
