// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string_view>

namespace palpate::device {

/// The mechanics of a haptic device as felt at its tip: the same in all directions, gravity balanced.
struct Mechanics {
  double mass{0.045};     ///< m, moving mass at the tip, kg, in [0.001, 10]
  double damping{0.005};  ///< b, viscous, N s/m, in [0, 100]
  double friction{0.26};  ///< Coulomb friction, N, in [0, 10]
};

/// A hand that holds the tip: a mass on it, a spring and a damper to where the hand wants to be.
struct Hand {
  double mass{0.1};         ///< M, kg, in [0, 10]
  double damping{2.0};      ///< B, N s/m, in [0, 1000]
  double stiffness{200.0};  ///< K, N/m, in [1, 1e5]
};

/// @throw std::invalid_argument naming the first field out of its range, its value and the range
void check(const Mechanics& device);
void check(const Hand& hand);

/// A device of the market. Where its figures come from: clients/device/README.md.
struct Preset {
  std::string_view name;
  Mechanics mechanics;
};

/// touch, omni, desktop, premium15, premium30: the names of the server's --device.
[[nodiscard]] std::span<const Preset> presets() noexcept;
/// Nothing for another name ("custom" is no preset: the caller's own numbers).
[[nodiscard]] std::optional<Preset> findPreset(std::string_view name) noexcept;

}  // namespace palpate::device
