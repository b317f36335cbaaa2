// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <string_view>

namespace palpate {

/// A haptic device of the market.
struct DevicePreset {
  std::string_view name;

  // What it renders, and how the default coupling keeps it stable.                        docs/design.md, Safety
  // The damping keeps what one tick answers to a step of the pose, at 1 kHz from rest, within the limit too:
  //   rendered_stiffness (1 + tau / 3 ms) <= stiffness_limit,   tau = b / rendered_stiffness     coupling_damper.h
  double force_limit;         ///< largest force, N
  double stiffness_limit;     ///< largest stiffness that it renders stably, N/m: no coupling is stiffer
  double rendered_stiffness;  ///< of organ and default coupling in series, N/m: at most 0.75 of the limit
  double coupling_damping;    ///< b, N s/m

  // How it moves, as felt at its tip.                                                    clients/device/README.md
  double mass;             ///< apparent, kg
  double viscous_damping;  ///< N s/m. No maker states it; it is small, and little damping is the harder case
  double friction;         ///< Coulomb, N
};

// Limits, mass and friction: the makers' data sheets.
inline constexpr std::array<DevicePreset, 5> kDevicePresets{{
    // name       N     N/m    N/m    N s/m  kg     N s/m  N
    {"touch", 3.3, 400.0, 300.0, 0.3, 0.045, 0.005, 0.26},
    {"omni", 3.3, 700.0, 400.0, 0.9, 0.045, 0.005, 0.26},
    {"desktop", 7.9, 1000.0, 500.0, 1.5, 0.045, 0.005, 0.06},
    {"premium15", 8.5, 800.0, 500.0, 0.9, 0.075, 0.005, 0.04},
    {"premium30", 22.0, 1000.0, 500.0, 1.5, 0.159, 0.005, 0.2},
}};

[[nodiscard]] constexpr std::span<const DevicePreset> devicePresets() noexcept {
  return kDevicePresets;
}

/// By name; nothing for another name ("custom" is no preset: the caller's own numbers).
[[nodiscard]] constexpr std::optional<DevicePreset> findDevicePreset(std::string_view name) noexcept {
  const auto found = std::find_if(kDevicePresets.begin(), kDevicePresets.end(),
                                  [name](const DevicePreset& preset) { return preset.name == name; });
  return found == kDevicePresets.end() ? std::nullopt : std::optional(*found);
}

}  // namespace palpate
