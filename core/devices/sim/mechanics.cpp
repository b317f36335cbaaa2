// SPDX-License-Identifier: Apache-2.0
#include "core/devices/sim/mechanics.h"

#include "core/devices/path/in_range.h"

namespace palpate::device {

void check(const Mechanics& device) {
  requireRange("device mass (kg)", device.mass, 0.001, 10.0);
  requireRange("device damping (N s/m)", device.damping, 0.0, 100.0);
  requireRange("device friction (N)", device.friction, 0.0, 10.0);
}

void check(const Hand& hand) {
  requireRange("hand mass (kg)", hand.mass, 0.0, 10.0);
  requireRange("hand damping (N s/m)", hand.damping, 0.0, 1000.0);
  requireRange("hand stiffness (N/m)", hand.stiffness, 1.0, 1e5);
}

Mechanics mechanicsOf(const DevicePreset& preset) noexcept {
  return {preset.mass, preset.viscous_damping, preset.friction};
}

}  // namespace palpate::device
