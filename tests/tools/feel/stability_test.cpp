// SPDX-License-Identifier: Apache-2.0
// The closed loop of palpate-feel coupling: each device in a loose hand presses on organs of 1 and 5 N/mm.
#include "palpate/feel/stability.h"

#include <gtest/gtest.h>

#include <string>

#include "palpate/feel/surface_path.h"
#include "uneven_organ.h"

namespace palpate::testing {

namespace {

constexpr device::Hand kLoose{0.02, 0.5, 50.0};  // kg, N s/m, N/m

/// A press at the top. @param[in] stiffness  of the organ there, along the normal, N/m
feel::StabilityCase pressOn(const DevicePreset& preset, double stiffness) {
  const ContactPoint s = unevenOrgan().surface().closestPoint(Vec3(0.0, 0.0, 0.05)).s;
  const double E = unevenOrgan().attributes().E * stiffness / feel::normalStiffness(unevenOrgan(), s);
  return {preset, E, kLoose, s};
}

class ClosedLoop : public ::testing::TestWithParam<DevicePreset> {};

}  // namespace

TEST_P(ClosedLoop, IsStableAtThePresetsCouplingWhichIsAtLeastHalfOfTheLargest) {
  for (const double stiffness : {1e3, 5e3}) {
    const feel::StabilityResult result = feel::stability(unevenOrgan(), pressOn(GetParam(), stiffness));
    EXPECT_TRUE(result.at_default.stable) << stiffness << " N/m";
    EXPECT_GT(result.at_default.max_force, 0.02) << "N: the organ was reached";
    EXPECT_GE(result.largest_stable, GetParam().coupling_stiffness) << stiffness << " N/m";
    EXPECT_GE(2.0 * GetParam().coupling_stiffness, result.largest_stable) << stiffness << " N/m";
  }
}

INSTANTIATE_TEST_SUITE_P(Presets, ClosedLoop,
                         ::testing::ValuesIn(devicePresets().begin(), devicePresets().end()),
                         [](const auto& row) { return std::string(row.param.name); });

TEST(ClosedLoopWithoutDamping, BuzzesWithACouplingFarAboveTheDevicesLimit) {
  for (const DevicePreset& preset : devicePresets()) {
    feel::StabilityCase which = pressOn(preset, 1e5);
    which.friction = false;
    which.preset.coupling_damping = 0.0;
    EXPECT_FALSE(feel::press(unevenOrgan(), which, 30.0 * preset.stiffness_limit).stable) << preset.name;
  }
}

}  // namespace palpate::testing
