// SPDX-License-Identifier: Apache-2.0
// The largest coupling that is stable under measured delays, for each device.
#include "tools/examine/feel/safe_coupling.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/response/largest_stiffness.h"
#include "tools/examine/feel/press_places.h"
#include "tools/examine/feel/surface_path.h"
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

struct Organ {
  std::vector<feel::PressPlace> places = feel::pressPlaces(unevenOrgan());
  double stiffness = largestStiffness(unevenOrgan());
};

std::vector<feel::StabilityCase> casesAt(const device::Delays& delays, const DevicePreset& preset,
                                         const ContactPoint& s, double stiffness) {
  static const double kOrgan = largestStiffness(unevenOrgan());
  return feel::casesUnder(delays, feel::withRendered(preset, stiffness), s, kOrgan, feel::kModuli.back());
}

class SafeCoupling : public ::testing::TestWithParam<DevicePreset> {};

}  // namespace

TEST_P(SafeCoupling, IsStableAFifthBelowAndRingsTwoFifthsAbove) {
  const device::Delays delays = busy();
  EXPECT_GT(delays.reordered(), 100U);
  EXPECT_GT(delays.lost(), 100U);
  const Organ organ;
  const feel::SafeCoupling safe =
      feel::safeCoupling(unevenOrgan(), delays, GetParam(), organ.places, organ.stiffness);
  ASSERT_GT(safe.rendered_stiffness, 1.0);
  EXPECT_FALSE(safe.by_device) << "these delays are the bound";
  EXPECT_LE(safe.rendered_stiffness, GetParam().rendered_stiffness);
  EXPECT_NEAR(safe.rendered_stiffness, 0.8 * safe.largest_stable, 1e-9);
  EXPECT_LE(safe.unstable_at, 1.04 * safe.largest_stable);
  EXPECT_NEAR(safe.damping / safe.rendered_stiffness,
              GetParam().coupling_damping / GetParam().rendered_stiffness, 1e-12);
  RecordProperty("rendered_N_per_m", std::to_string(safe.rendered_stiffness));
  for (const feel::PressPlace& place : organ.places) {
    EXPECT_FALSE(
        feel::firstUnstable(unevenOrgan(), casesAt(delays, GetParam(), place.s, safe.rendered_stiffness)))
        << place.name;
    for (const feel::StabilityCase& which :
         casesAt(delays, GetParam(), place.s, 0.8 * safe.rendered_stiffness)) {
      const device::Verdict verdict = feel::press(unevenOrgan(), which, std::nullopt);
      EXPECT_TRUE(verdict.stable) << place.name << ", " << which.hand.stiffness << " N/m, friction "
                                  << which.friction << ", " << verdict.oscillation_pp << " m";
      EXPECT_GT(verdict.max_force, 0.005) << "N: the organ was reached";
    }
  }
  ASSERT_TRUE(safe.place);
  RecordProperty("place", std::string(safe.place->name));
  EXPECT_TRUE(feel::firstUnstable(unevenOrgan(),
                                  casesAt(delays, GetParam(), safe.place->s, 1.4 * safe.rendered_stiffness)));
  ASSERT_TRUE(safe.rings);
  EXPECT_FALSE(feel::press(unevenOrgan(), *safe.rings, std::nullopt).stable);
}

TEST_P(SafeCoupling, OnAQuietMachineTheDeviceIsTheBound) {
  const Organ organ;
  const feel::SafeCoupling safe =
      feel::safeCoupling(unevenOrgan(), quiet(), GetParam(), organ.places, organ.stiffness);
  EXPECT_TRUE(safe.by_device);
  EXPECT_FALSE(safe.place);
  EXPECT_EQ(safe.rendered_stiffness, GetParam().rendered_stiffness);
  EXPECT_EQ(safe.damping, GetParam().coupling_damping);
}

// Places that ring from a stiffness that is known.
TEST(StiffestStable, IsWhatHoldsAtEachPlace) {
  const std::vector<feel::PressPlace> places{
      {"highest", {}}, {"median", {}}, {"softest", {}}, {"stiffest", {}}};
  const auto search = [&](const std::map<std::string_view, double>& rings_from, double softer = 1e9) {
    return feel::stiffestStable(
        places, 300.0, [&](const feel::PressPlace& place, double stiffness, double E) {
          return stiffness <
                 (E < 1e4 ? std::min(softer, rings_from.at(place.name)) : rings_from.at(place.name));
        });
  };
  const feel::SafeCoupling second =
      search({{"highest", 100.0}, {"median", 60.0}, {"softest", 80.0}, {"stiffest", 90.0}});
  EXPECT_NEAR(second.largest_stable, 60.0, 0.03 * 60.0);
  EXPECT_LT(second.largest_stable, 60.0);
  EXPECT_GE(second.unstable_at, 60.0);
  EXPECT_EQ(second.place.value().name, "median");
  const feel::SafeCoupling last =
      search({{"highest", 900.0}, {"median", 900.0}, {"softest", 900.0}, {"stiffest", 200.0}});
  EXPECT_NEAR(last.largest_stable, 200.0, 0.03 * 200.0);
  EXPECT_EQ(last.place.value().name, "stiffest");
  EXPECT_FALSE(last.by_device);
  const feel::SafeCoupling soft =
      search({{"highest", 900.0}, {"median", 60.0}, {"softest", 900.0}, {"stiffest", 900.0}}, 40.0);
  EXPECT_NEAR(soft.largest_stable, 40.0, 0.05 * 40.0) << "a softer organ rings from less";
  // The first place rings from 75 to 78 N/m, the second from 77: what the second allows has to hold at the first too.
  const feel::SafeCoupling pocket = feel::stiffestStable(
      std::span(places).first(2), 100.0, [](const feel::PressPlace& place, double stiffness, double) {
        return place.name == "highest" ? stiffness < 75.0 || stiffness > 78.0 : stiffness < 77.0;
      });
  EXPECT_LT(pocket.largest_stable, 75.0);
  EXPECT_GE(pocket.unstable_at, 75.0);
  // Rings from 50 to 55 N/m and from 66: the steps upward pass over the first, and 0.8 of what they find lies in it.
  const feel::SafeCoupling under = feel::stiffestStable(
      std::span(places).first(1), 300.0, [](const feel::PressPlace&, double stiffness, double) {
        return stiffness < 50.0 || (stiffness > 55.0 && stiffness < 66.0);
      });
  EXPECT_LT(under.largest_stable, 50.0);
  EXPECT_NEAR(under.unstable_at, 51.0, 1.5);
  const feel::SafeCoupling none =
      search({{"highest", 900.0}, {"median", 900.0}, {"softest", 900.0}, {"stiffest", 900.0}});
  EXPECT_EQ(none.largest_stable, 300.0);
  EXPECT_FALSE(none.place);
  EXPECT_TRUE(none.by_device);
  EXPECT_EQ(
      search({{"highest", 1.0}, {"median", 60.0}, {"softest", 80.0}, {"stiffest", 90.0}}).largest_stable,
      0.0);
}

INSTANTIATE_TEST_SUITE_P(Presets, SafeCoupling,
                         ::testing::ValuesIn(devicePresets().begin(), devicePresets().end()),
                         [](const auto& row) { return std::string(row.param.name); });

TEST(PressPlaces, AreTheHighestNodeAndThoseOfTheLeastMedianAndLargestStiffness) {
  const std::vector<feel::PressPlace> places = feel::pressPlaces(unevenOrgan());
  const SurfaceMesh& surface = unevenOrgan().surface();
  ASSERT_EQ(places.size(), 4U);
  std::map<std::string_view, double> stiffness;
  for (const feel::PressPlace& place : places)
    stiffness[place.name] = feel::normalStiffness(unevenOrgan(), place.s);
  EXPECT_LT(1.2 * stiffness.at("softest"), stiffness.at("median"));
  EXPECT_LT(1.2 * stiffness.at("median"), stiffness.at("stiffest"));
  EXPECT_EQ(places.front().name, "highest");
  for (const feel::PressPlace& place : places)
    EXPECT_LE(surface.position(place.s).z(), surface.position(places.front().s).z());
}

TEST(SafeCouplingSetting, IsAConfigurationOfTheServer) {
  const std::vector<std::string> origin{"made of delays.csv", "rings at the top"};
  EXPECT_EQ(
      feel::settingOf(*findDevicePreset("omni"), {123.456789, 0.25, false, 150.0, 155.0, {}, {}}, origin),
      "# The stiffest that device omni may be given under measured delays: palpate-server --config FILE\n"
      "# made of delays.csv\n"
      "# rings at the top\n"
      "device = \"omni\"\n\n[tool]\n"
      "rendered_stiffness = 123.457  # N/m, of organ and coupling in series\n"
      "coupling_damping = 0.25  # N s/m\n");
}

}  // namespace palpate::testing
