// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/devices/device_preset.h"

namespace palpate::device {

/// The mechanics of a haptic device, felt at its tip: equal in all directions, gravity balanced.
struct Mechanics {
  double mass{0.045};     ///< m, moving mass at the tip, kg, in [0.001, 10]
  double damping{0.005};  ///< b, viscous, N s/m, in [0, 100]
  double friction{0.26};  ///< Coulomb friction, N, in [0, 10]
};

/// A hand that holds the tip: a mass on the tip, a spring and a damper to the hand's wanted position.
struct Hand {
  double mass{0.1};         ///< M, kg, in [0, 10]
  double damping{2.0};      ///< B, N s/m, in [0, 1000]
  double stiffness{200.0};  ///< K, N/m, in [1, 1e5]
};

/// Of the hands of `palpate-feel coupling` the loosest: it damps least, so it rings first. That of palpate-device --delay-from.
inline constexpr Hand kLoosestHand{0.02, 0.5, 50.0};

/// @throw std::invalid_argument naming the first field out of its range, its value and the range
void check(const Mechanics& device);
void check(const Hand& hand);

/// The mechanics of a preset.
[[nodiscard]] Mechanics mechanicsOf(const DevicePreset& preset) noexcept;

}  // namespace palpate::device
