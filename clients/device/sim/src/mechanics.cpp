// SPDX-License-Identifier: Apache-2.0
#include "palpate/device/mechanics.h"

#include <sstream>
#include <stdexcept>

namespace palpate::device {
namespace {

void inRange(const char* name, double value, double low, double high) {
  if (value >= low && value <= high) return;
  std::ostringstream line;
  line << name << " is " << value << ", expected " << low << " to " << high;
  throw std::invalid_argument(line.str());
}

}  // namespace

void check(const Mechanics& device) {
  inRange("device mass (kg)", device.mass, 0.001, 10.0);
  inRange("device damping (N s/m)", device.damping, 0.0, 100.0);
  inRange("device friction (N)", device.friction, 0.0, 10.0);
}

void check(const Hand& hand) {
  inRange("hand mass (kg)", hand.mass, 0.0, 10.0);
  inRange("hand damping (N s/m)", hand.damping, 0.0, 1000.0);
  inRange("hand stiffness (N/m)", hand.stiffness, 1.0, 1e5);
}

Mechanics mechanicsOf(const DevicePreset& preset) noexcept {
  return {preset.mass, preset.viscous_damping, preset.friction};
}

}  // namespace palpate::device
