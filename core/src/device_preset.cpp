// SPDX-License-Identifier: Apache-2.0
#include "palpate/core/device_preset.h"

#include <algorithm>
#include <array>

namespace palpate {

namespace {

// Limits: docs/design.md, Safety, the makers' data sheets.
constexpr std::array<DevicePreset, 5> kPresets{{
    {"touch", 3.3, 400.0, 300.0, 0.3},
    {"omni", 3.3, 700.0, 400.0, 0.9},
    {"desktop", 7.9, 1000.0, 500.0, 1.5},
    {"premium15", 8.5, 800.0, 500.0, 0.9},
    {"premium30", 22.0, 1000.0, 500.0, 1.5},
}};

}  // namespace

std::span<const DevicePreset> devicePresets() noexcept {
  return kPresets;
}

std::optional<DevicePreset> findDevicePreset(std::string_view name) noexcept {
  const auto found = std::find_if(kPresets.begin(), kPresets.end(),
                                  [name](const DevicePreset& preset) { return preset.name == name; });
  return found == kPresets.end() ? std::nullopt : std::optional(*found);
}

void apply(const DevicePreset& preset, StepConfig& config) noexcept {
  config.force_limit = preset.force_limit;
  config.coupling_stiffness = preset.coupling_stiffness;
  config.coupling_damping = preset.coupling_damping;
}

}  // namespace palpate
