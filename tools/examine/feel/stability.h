// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "core/base/contact_point.h"
#include "core/devices/device_preset.h"
#include "core/devices/sim/delays.h"
#include "core/devices/sim/held_device.h"
#include "core/devices/sim/mechanics.h"
#include "core/devices/sim/verdict.h"
#include "core/model/meta_model.h"
#include "core/tick/apply_preset.h"

namespace palpate::feel {

/// A device in a hand that presses on an organ of a given stiffness.
struct StabilityCase {
  DevicePreset preset;
  double youngs_modulus;  ///< E, Pa
  device::Hand hand;
  ContactPoint s;                         ///< where it presses
  double organ_stiffness;                 ///< K_max, N/m
  bool friction{true};                    ///< of the device; without it only hand and coupling damp
  const device::Delays* delays{nullptr};  ///< of the answers; nothing: one period
  std::size_t first_delay{0};             ///< period of their measurement with which the press begins
};

/// Where the search for the largest stable coupling ends, N/m: thirty times what the stiffest device renders. Damping in
/// proportion to it stays within what StepConfig takes.
inline constexpr double kStiffestCoupling = 3e4;

/// The largest stable coupling, and whether the default one is stable.
struct StabilityResult {
  device::Verdict at_default;
  /// N/m, within 3 % of the larger of it and what the preset renders; 0: none; kStiffestCoupling: all that were tried.
  /// The search goes on beyond the preset's stiffness limit, so that it tells how much the limit leaves.
  double largest_stable{0.0};
};

/// One press through step(), closed loop at 1 kHz; the answer arrives one period later, or as was measured.
/// @param[in] coupling_stiffness  N/m, damped for as long as the preset's; nothing: the default, which follows the organ
[[nodiscard]] device::Verdict press(const MetaModel& model, const StabilityCase& which,
                                    std::optional<double> coupling_stiffness);

/// K_vc of the default coupling, N/m; infinity: none.
[[nodiscard]] double defaultCoupling(const MetaModel& model, const StabilityCase& which);

/// Tries the default coupling, then what the preset renders and its doubles up to the first unstable one, then bisects 5
/// times. A coupling that is stable beyond an unstable one is not found.
[[nodiscard]] StabilityResult stability(const MetaModel& model, const StabilityCase& which);

}  // namespace palpate::feel
