// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "core/tick/coupling_choice.h"
#include "palpate/server/config.h"

namespace palpate::server {

/// What a request may set: each parameter from lowest to highest.
struct LiveLimits {
  LiveParameters lowest;
  LiveParameters highest;
};

/// The values that a hand feels, once a change of them is over: E by its number, the coupling as it follows the organ.
[[nodiscard]] LiveParameters asFelt(const ToolSettings& settings, const OrganStiffness& organ) noexcept;

/// The bounds that were named. Otherwise a parameter may be lowered within its range and raised back to the start's value,
/// which the operator chose for the device: less E, friction, coupling, damping or force is never less safe.
/// @param start  the values of the start; E is a number, never 0
[[nodiscard]] LiveLimits liveLimits(const LiveParameters& start, const LiveBounds& named);

/// The tip that a driver may name: the bounds that were named, else half to twice the radius of the start, so that contact
/// begins that much earlier or later. m
[[nodiscard]] Bounds tipLimits(double start, const std::optional<Bounds>& named) noexcept;

/// @return the first bounds named that are out of the parameter's range, above what the device renders stably, or without
/// the start's value. E is judged only where the start names it.
[[nodiscard]] std::optional<Complaint> limitsComplaint(const ServerConfig& config);

}  // namespace palpate::server
