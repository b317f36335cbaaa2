// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/base/contact_point.h"
#include "core/devices/device_preset.h"
#include "core/devices/sim/delays.h"
#include "core/devices/sim/mechanics.h"
#include "core/model/meta_model.h"
#include "tools/examine/feel/press_places.h"
#include "tools/examine/feel/stability.h"

namespace palpate::feel {

/// Hands of `palpate-feel coupling`: loose, ordinary, firm; kg, N s/m, N/m.
inline constexpr std::array<device::Hand, 3> kHands{
    {device::kLoosestHand, {0.1, 2.0, 200.0}, {0.2, 5.0, 500.0}}};
/// Organs of `palpate-feel coupling`: E, Pa.
inline constexpr std::array<double, 4> kModuli{5e3, 20e3, 160e3, 1e6};

/// Of the largest stable coupling this share is safe: what is tried has three hands, real ones differ.
inline constexpr double kSafeShare = 0.8;

/// The largest safe coupling of a device under measured delays.
struct SafeCoupling {
  /// Of organ and coupling in series, N/m: tool.rendered_stiffness of the server. kSafeShare of largest_stable, and at most the
  /// preset's; 0: none is stable.
  double rendered_stiffness{0.0};
  double damping{0.0};         ///< b of the coupling, N s/m, in proportion: tool.coupling_damping
  bool by_device{false};       ///< the preset is the bound, the delays are not
  double largest_stable{0.0};  ///< N/m; where the device is the bound at least this
  /// The least that was tried and is not stable, N/m; 0 where the device is the bound.
  double unstable_at{0.0};
  std::optional<StabilityCase> rings;  ///< a case that is not stable there
  std::optional<PressPlace> place;     ///< where that is: no other place rings from less on
};

/// The preset with another rendered stiffness, its damping in proportion.
[[nodiscard]] DevicePreset withRendered(DevicePreset preset, double stiffness) noexcept;

/// Cases that judge a coupling under delays: each hand, with and without the device's friction, over the beginning of the
/// measurement and over its worst stretch. @param[in] youngs_modulus  Pa
[[nodiscard]] std::vector<StabilityCase> casesUnder(const device::Delays& delays, const DevicePreset& preset,
                                                    const ContactPoint& s, double organ_stiffness,
                                                    double youngs_modulus);

/// The first case that is unstable; nothing where all are stable.
[[nodiscard]] std::optional<StabilityCase> firstUnstable(const MetaModel& model,
                                                         std::span<const StabilityCase> cases);

/// Whether a device is stable at a place; of K_r, N/m, and E, Pa.
using Stable = std::function<bool(const PressPlace&, double, double)>;

/// At the first place upward from 8 N/m in steps of 1.25 to the first K_r that is unstable on the stiffest organ,
/// then by bisection to 3 %; lowered further where a softer organ is unstable with it, or 0.8 of it rings, or 0.64.
/// It ends at `most`, N/m. At each other place what was found is tried; where it rings, the search is made there
/// too, up to it, and all places are tried again.
/// @param[in] places  at least one  @return largest_stable, unstable_at, place and by_device
[[nodiscard]] SafeCoupling stiffestStable(std::span<const PressPlace> places, double most,
                                          const Stable& stable);

/// That of a device under delays, which is stable where all of casesUnder() are.
/// @param[in] places  e.g. pressPlaces()
[[nodiscard]] SafeCoupling safeCoupling(const MetaModel& model, const device::Delays& delays,
                                        const DevicePreset& preset, std::span<const PressPlace> places,
                                        double organ_stiffness);

/// The server's configuration with it, as TOML. @param[in] origin  lines: what was computed from which file
[[nodiscard]] std::string settingOf(const DevicePreset& preset, const SafeCoupling& coupling,
                                    std::span<const std::string> origin);

}  // namespace palpate::feel
