// SPDX-License-Identifier: Apache-2.0
// The largest coupling that is stable under measured delays, for each device.
#include "tools/examine/feel/safe_coupling.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <string>
#include <vector>

#include "core/response/largest_stiffness.h"
#include "uneven_organ.h"

namespace palpate::testing {

namespace {

// As of a busy machine: answers after 2.3 to 6.3 ms, a fiftieth lost, now and then one that a later one overtakes, and a driver
// that sleeps over 3 periods.
device::Delays busy() {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> delay(2.3e-3, 6.3e-3), share(0.0, 1.0);
  std::vector<device::DelaySample> samples;
  for (int i = 0; i < 12000; ++i) {
    if (i % 700 < 3) continue;
    const double sent = 1e-3 * i;
    samples.push_back({sent, sent + delay(random)});
    if (share(random) < 0.02) samples.back().answered_s.reset();
  }
  return device::Delays(samples);
}

device::Delays quiet() {
  std::vector<device::DelaySample> samples;
  for (int i = 0; i < 1000; ++i) samples.push_back({1e-3 * i, 1e-3 * i + 0.6e-3});
  return device::Delays(samples);
}

struct Place {
  ContactPoint s = unevenOrgan().surface().closestPoint(Vec3(0.0, 0.0, 0.05)).s;
  double stiffness = largestStiffness(unevenOrgan());
};

std::vector<feel::StabilityCase> casesAt(const device::Delays& delays, const DevicePreset& preset,
                                         double stiffness) {
  const Place place;
  return feel::casesUnder(delays, feel::withRendered(preset, stiffness), place.s, place.stiffness,
                          feel::kModuli.back());
}

class SafeCoupling : public ::testing::TestWithParam<DevicePreset> {};

}  // namespace

TEST_P(SafeCoupling, IsStableAFifthBelowAndRingsTwoFifthsAbove) {
  const device::Delays delays = busy();
  EXPECT_GT(delays.reordered(), 100U);
  EXPECT_GT(delays.lost(), 100U);
  const Place place;
  const feel::SafeCoupling safe =
      feel::safeCoupling(unevenOrgan(), delays, GetParam(), place.s, place.stiffness);
  ASSERT_GT(safe.rendered_stiffness, 1.0);
  EXPECT_FALSE(safe.by_device) << "these delays are the bound";
  EXPECT_LE(safe.rendered_stiffness, GetParam().rendered_stiffness);
  EXPECT_NEAR(safe.rendered_stiffness, 0.8 * safe.largest_stable, 1e-9);
  EXPECT_LE(safe.unstable_at, 1.04 * safe.largest_stable);
  EXPECT_NEAR(safe.damping / safe.rendered_stiffness,
              GetParam().coupling_damping / GetParam().rendered_stiffness, 1e-12);
  RecordProperty("rendered_N_per_m", std::to_string(safe.rendered_stiffness));
  EXPECT_FALSE(feel::firstUnstable(unevenOrgan(), casesAt(delays, GetParam(), safe.rendered_stiffness)));
  for (const feel::StabilityCase& which : casesAt(delays, GetParam(), 0.8 * safe.rendered_stiffness)) {
    const device::Verdict verdict = feel::press(unevenOrgan(), which, std::nullopt);
    EXPECT_TRUE(verdict.stable) << which.hand.stiffness << " N/m, friction " << which.friction << ", "
                                << verdict.oscillation_pp << " m";
    EXPECT_GT(verdict.max_force, 0.005) << "N: the organ was reached";
  }
  EXPECT_TRUE(feel::firstUnstable(unevenOrgan(), casesAt(delays, GetParam(), 1.4 * safe.rendered_stiffness)));
  ASSERT_TRUE(safe.rings);
  EXPECT_FALSE(feel::press(unevenOrgan(), *safe.rings, std::nullopt).stable);
}

TEST_P(SafeCoupling, OnAQuietMachineTheDeviceIsTheBound) {
  const Place place;
  const feel::SafeCoupling safe =
      feel::safeCoupling(unevenOrgan(), quiet(), GetParam(), place.s, place.stiffness);
  EXPECT_TRUE(safe.by_device);
  EXPECT_EQ(safe.rendered_stiffness, GetParam().rendered_stiffness);
  EXPECT_EQ(safe.damping, GetParam().coupling_damping);
  EXPECT_FALSE(
      feel::firstUnstable(unevenOrgan(), casesAt(quiet(), GetParam(), 0.8 * safe.rendered_stiffness)));
}

INSTANTIATE_TEST_SUITE_P(Presets, SafeCoupling,
                         ::testing::ValuesIn(devicePresets().begin(), devicePresets().end()),
                         [](const auto& row) { return std::string(row.param.name); });

TEST(SafeCouplingSetting, IsAConfigurationOfTheServer) {
  EXPECT_EQ(
      feel::settingOf(*findDevicePreset("omni"), {123.456789, 0.25, false, 150.0, 155.0, {}},
                      "made of delays.csv"),
      "# The stiffest that device omni may be given under measured delays: palpate-server --config FILE\n"
      "# made of delays.csv\n"
      "device = \"omni\"\n\n[tool]\n"
      "rendered_stiffness = 123.457  # N/m, of organ and coupling in series\n"
      "coupling_damping = 0.25  # N s/m\n");
}

}  // namespace palpate::testing
