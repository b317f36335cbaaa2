// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "palpate/core/step_config.h"
#include "palpate/devices/device_preset.h"

namespace palpate {

/// Force limit and coupling of a device.
inline void apply(const DevicePreset& preset, StepConfig& config) noexcept {
  config.force_limit = preset.force_limit;
  config.coupling_stiffness = preset.coupling_stiffness;
  config.coupling_damping = preset.coupling_damping;
}

}  // namespace palpate
