// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/devices/device_preset.h"
#include "core/tick/step_config.h"

namespace palpate {

/// Force limit and coupling of a device: one that follows the organ.
inline void apply(const DevicePreset& preset, StepConfig& config) noexcept {
  config.force_limit = preset.force_limit;
  config.coupling_stiffness = StepConfig{}.coupling_stiffness;
  config.rendered_stiffness = preset.rendered_stiffness;
  config.coupling_damping = preset.coupling_damping;
}

}  // namespace palpate
