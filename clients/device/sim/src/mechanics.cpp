// SPDX-License-Identifier: Apache-2.0
#include "palpate/device/mechanics.h"

#include <algorithm>
#include <array>
#include <sstream>
#include <stdexcept>

namespace palpate::device {
namespace {

// Mass and friction: the makers' data sheets. No maker states a viscous damping; it is small, and little damping is
// the harder case for stability (clients/device/README.md).
constexpr std::array<Preset, 5> kPresets{{
    {"touch", {0.045, 0.005, 0.26}},
    {"omni", {0.045, 0.005, 0.26}},
    {"desktop", {0.045, 0.005, 0.06}},
    {"premium15", {0.075, 0.005, 0.04}},
    {"premium30", {0.159, 0.005, 0.2}},
}};

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

std::span<const Preset> presets() noexcept {
  return kPresets;
}

std::optional<Preset> findPreset(std::string_view name) noexcept {
  const auto found =
      std::find_if(kPresets.begin(), kPresets.end(), [name](const Preset& p) { return p.name == name; });
  return found == kPresets.end() ? std::nullopt : std::optional(*found);
}

}  // namespace palpate::device
