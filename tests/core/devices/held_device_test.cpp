// SPDX-License-Identifier: Apache-2.0
#include "core/devices/sim/held_device.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <stdexcept>

namespace palpate::device {
namespace {

Path resting() {
  return Path({0, 0, 0}, {{{0, 0, 0}, 1.0, "rest"}});
}

TEST(HeldDevice, SwingsAndDecaysLikeTheClosedForm) {
  const Mechanics device{0.05, 0.3, 0.0};
  const Hand hand{0.1, 0.7, 200.0};
  HeldDevice held(device, hand, resting());
  held.place({0.01, 0, -0.004}, {});
  const double m = 0.15, b = 1.0, K = 200.0;
  const double decay = b / (2.0 * m);
  const double w = std::sqrt(K / m - decay * decay);
  double worst = 0.0;
  for (int i = 1; i <= 1000; ++i) {
    held.step({}, 1e-3);
    const double t = 1e-3 * i;
    const double x = 0.01 * std::exp(-decay * t) * (std::cos(w * t) + decay / w * std::sin(w * t));
    worst = std::max(worst, std::abs(held.position()[0] - x));
    EXPECT_NEAR(held.position()[2], -0.4 * held.position()[0], 1e-12);
  }
  EXPECT_LT(worst, 1e-6) << "of 10 mm, after " << w / (2 * std::numbers::pi) << " periods";
}

TEST(HeldDevice, CoulombFrictionTakesFourTimesItsDeadBandInEachPeriod) {
  const double K = 200.0, c = 0.1;
  HeldDevice held({0.05, 0.0, c}, {0.1, 0.0, K}, resting());
  held.place({0.01, 0, 0}, {});
  const double period = 2.0 * std::numbers::pi * std::sqrt(0.15 / K);
  for (int k = 1; k <= 2; ++k) {
    held.step({}, period);
    EXPECT_NEAR(held.position()[0], 0.01 - k * 4.0 * c / K, 2e-5);
  }
  for (int i = 0; i < 2000; ++i) held.step({}, 1e-3);
  EXPECT_LE(std::abs(held.position()[0]), c / K * 1.01);
  EXPECT_EQ(length(held.velocity()), 0.0) << "friction holds it";
}

TEST(HeldDevice, EnergyNeverGrowsWithoutForce) {
  for (const double friction : {0.0, 0.26}) {
    HeldDevice held({0.045, 0.0, friction}, {0.02, 0.0, 500.0}, resting());
    held.place({0.01, 0.003, -0.02}, {0.5, -0.3, 0.1});
    const double at_start = held.energy();
    double before = at_start;
    for (int i = 0; i < 20000; ++i) {
      held.step({}, 1e-3);
      EXPECT_LE(held.energy(), before + 1e-12 * at_start);
      before = held.energy();
    }
    if (friction == 0.0) {
      EXPECT_NEAR(before, at_start, 1e-9 * at_start) << "nor falls without damping";
    } else {
      EXPECT_LT(before, 0.1 * at_start);
    }
  }
}

TEST(HeldDevice, EnergyIsWhatTheForceHasPutIn) {
  HeldDevice held({0.045, 0.0, 0.0}, {0.1, 0.0, 200.0}, resting());
  for (int i = 0; i < 500; ++i) held.step({std::sin(0.1 * i), 0.2, i % 100 < 50 ? 1.0 : -1.0}, 1e-3);
  EXPECT_GT(held.energy(), 1e-4);
  EXPECT_NEAR(held.energy(), held.alongForce().work, 1e-9 * held.energy());
}

TEST(HeldDevice, RestsWhereForceAndHandBalance) {
  HeldDevice held({0.045, 0.1, 0.0}, {0.1, 5.0, 200.0}, resting());
  for (int i = 0; i < 3000; ++i) held.step({0, 0, 1.0}, 1e-3);
  EXPECT_NEAR(held.position()[2], 1.0 / 200.0, 1e-7);
}

TEST(HeldDevice, AStepIsTheSameInParts) {
  HeldDevice once({}, {}, resting()), often({}, {}, resting());
  once.step({0, 0.4, 1.0}, 4e-3);
  for (int i = 0; i < 4; ++i) often.step({0, 0.4, 1.0}, 1e-3);
  EXPECT_NEAR(length(once.position() - often.position()), 0.0, 1e-12);
}

TEST(HeldDevice, RejectsWhatNoDeviceHas) {
  const auto complaint = [](const Mechanics& device, const Hand& hand) -> std::string {
    try {
      const HeldDevice held(device, hand, resting());
      return "accepted";
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
  };
  EXPECT_EQ(complaint({0.0, 0.0, 0.0}, {}), "device mass (kg) is 0, expected 0.001 to 10");
  EXPECT_EQ(complaint({0.1, -1.0, 0.0}, {}), "device damping (N s/m) is -1, expected 0 to 100");
  EXPECT_EQ(complaint({0.1, 0.0, 11.0}, {}), "device friction (N) is 11, expected 0 to 10");
  EXPECT_EQ(complaint({}, {-0.1, 2.0, 200.0}), "hand mass (kg) is -0.1, expected 0 to 10");
  EXPECT_EQ(complaint({}, {0.1, NAN, 200.0}), "hand damping (N s/m) is nan, expected 0 to 1000");
  EXPECT_EQ(complaint({}, {0.1, 2.0, 0.0}), "hand stiffness (N/m) is 0, expected 1 to 100000");
}

TEST(Presets, AreMechanicsThatAreTaken) {
  for (const DevicePreset& preset : devicePresets())
    EXPECT_NO_THROW(check(mechanicsOf(preset))) << preset.name;
  EXPECT_EQ(mechanicsOf(*findDevicePreset("premium30")).mass, 0.159);
  EXPECT_FALSE(findDevicePreset("custom"));
}

}  // namespace
}  // namespace palpate::device
