// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "core/devices/sim/held_device.h"
#include "core/devices/sim/verdict.h"

namespace palpate::device {

/// One contact, from the first force to the next period without one. A passive organ is at rest before and after, so over a
/// contact it gives nothing. A sampled one does: its force answers where the tip was, so it pulls longer than it pushed. A
/// spring k whose force lags by T gives k T v^2 a second, as a damper of -k T would. It stays stable while device and hand
/// damp more than that along the force (docs/decisions/device_simulation.md).
struct ContactEnergy {
  std::size_t first{0};       ///< entry of the trace with the first force
  std::size_t last{0};        ///< and with the last
  AlongForce along{};         ///< of this contact alone
  double largest_force{0.0};  ///< N
  bool stalled{false};  ///< the answers stayed away in it, or the server faded the force: Trace::stalled

  /// Work of the organ on the tool less what device and hand damped along the force, J. Above 0 the loop gained energy.
  [[nodiscard]] double excess() const noexcept { return along.work - along.damped; }
  /// What the largest force does over kNoiseFloor, J: no device could show less.
  [[nodiscard]] double floor() const noexcept { return largest_force * kNoiseFloor; }
  [[nodiscard]] bool holds() const noexcept { return excess() <= floor(); }  // false for NaN
};

/// The contacts of a run, and what they say together.
struct EnergyVerdict {
  std::vector<ContactEnergy> contacts;  ///< that ended, in the order of time
  AlongForce judged{};                  ///< sum over the contacts without a stall
  AlongForce stalled{};   ///< and over those with one. They tell nothing of the loop, and are not judged
  std::size_t stalls{0};  ///< number of the latter

  /// The contact without a stall that gained most; nullptr without any.
  [[nodiscard]] const ContactEnergy* worst() const noexcept;
  /// Whether no contact without a stall gained energy.
  [[nodiscard]] bool holds() const noexcept;
};

/// Forces below this are none, N: less than any preset's friction.
inline constexpr double kLeastForce = 1e-3;

/// @param[in] trace  with its energy
[[nodiscard]] EnergyVerdict judgeEnergy(const Trace& trace);

}  // namespace palpate::device
