// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string_view>

#include "palpate/core/step_config.h"

namespace palpate {

/// What a haptic device stands, and the coupling that keeps it stable.                 docs/design.md, Safety
/// The damping keeps what a step of the pose is answered with in one tick, at 1 kHz from rest, within the limit too:
///   K_vc (1 + (b / K_vc) / 3 ms) <= stiffness_limit                                      coupling_damper.h
struct DevicePreset {
  std::string_view name;
  double force_limit;         ///< largest force, N
  double stiffness_limit;     ///< largest stiffness that it renders stably, N/m: no coupling is stiffer
  double coupling_stiffness;  ///< K_vc, N/m
  double coupling_damping;    ///< N s/m
};

/// touch, omni, desktop, premium15, premium30.
[[nodiscard]] std::span<const DevicePreset> devicePresets() noexcept;
/// By name; nothing for another name ("custom" is no preset: the caller's own numbers).
[[nodiscard]] std::optional<DevicePreset> findDevicePreset(std::string_view name) noexcept;
/// Force limit and coupling of a device.
void apply(const DevicePreset& preset, StepConfig& config) noexcept;

}  // namespace palpate
