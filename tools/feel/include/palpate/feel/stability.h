// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>
#include <vector>

#include "palpate/core/device_preset.h"
#include "palpate/core/meta_model.h"
#include "palpate/device/held_device.h"
#include "palpate/device/verdict.h"

namespace palpate::feel {

/// A device in a hand that presses on an organ of a given stiffness.
struct StabilityCase {
  DevicePreset preset;
  double youngs_modulus;  ///< E, Pa
  device::Hand hand;
  ContactPoint s;       ///< where it presses
  bool friction{true};  ///< of the device; without it only hand and coupling damp
};

/// The largest stable coupling, and whether the preset's own is stable.
struct StabilityResult {
  device::Verdict at_default;
  double largest_stable{0.0};  ///< N/m, of those tried up to the preset's stiffness limit; 0: none
};

/// One press through step(), closed loop at 1 kHz; the answer arrives one period later.
/// @param[in] coupling_stiffness  N/m; the damping keeps the preset's ratio to it
[[nodiscard]] device::Verdict press(const MetaModel& model, const StabilityCase& which,
                                    double coupling_stiffness);

/// Tries the preset's coupling, then bisects 8 times for the largest stable one.
[[nodiscard]] StabilityResult stability(const MetaModel& model, const StabilityCase& which);

}  // namespace palpate::feel
