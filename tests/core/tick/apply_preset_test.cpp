// SPDX-License-Identifier: Apache-2.0
#include "core/tick/apply_preset.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "../driver.h"

namespace palpate::testing {

namespace {

constexpr double kStep = 1e-4;  // m

/// Largest |df| / |dx| of a stiff organ that is pressed stepwise, 2 mm deep, with a rest of so many ticks between steps.
double renderedStiffness(const MetaModel& organ, const DevicePreset& preset, int rest) {
  StepConfig config;
  apply(preset, config);
  config.youngs_modulus = 1e6;
  Driver driver(organ, config);
  const double top = organ.surface().closestPoint(Vec3(0.0, 0.0, 1.0)).position.z() + config.tip_radius;
  driver.settle(Vec3(0.0, 0.0, top + 0.001));
  Vec3 last = Vec3::Zero();
  double most = 0.0;
  for (int i = -5; i < 20; ++i)
    for (int tick = 0; tick < rest; ++tick) {
      const Vec3 force = vec(driver.at(Vec3(0.0, 0.0, top - i * kStep)).force);
      most = std::max(most, (force - last).norm() / kStep);
      last = force;
    }
  return most;
}

}  // namespace

TEST(DevicePreset, AStepIsAnsweredWithinTheDevicesStiffness) {
  const MetaModel organ = loadSynthetic();
  for (const DevicePreset& preset : devicePresets())
    for (const int rest : {1, 20}) {  // a steady press, and single steps
      const double stiffness = renderedStiffness(organ, preset, rest);
      EXPECT_LE(stiffness, 1.02 * preset.stiffness_limit) << preset.name << ", rest " << rest;
      EXPECT_GE(stiffness, 0.6 * preset.rendered_stiffness) << preset.name << ": nothing was felt";
    }
}

TEST(DevicePreset, IsAConfigurationThatIsTaken) {
  for (const DevicePreset& preset : devicePresets()) {
    StepConfig config;
    apply(preset, config);
    EXPECT_NO_THROW(check(config)) << preset.name;
    const double time = preset.coupling_damping / preset.rendered_stiffness;
    EXPECT_LE(preset.rendered_stiffness, 0.75 * preset.stiffness_limit) << preset.name;
    EXPECT_LE(preset.rendered_stiffness * (1.0 + time / 3e-3), preset.stiffness_limit * (1.0 + 1e-9))
        << preset.name;
  }
}

}  // namespace palpate::testing
