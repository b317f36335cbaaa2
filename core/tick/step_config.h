// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <limits>
#include <optional>

#include "core/base/live_parameters.h"
#include "core/base/max_tools.h"

namespace palpate {

/// Largest coupling_damping / coupling_stiffness, s: the damper answers a change of the force of one tick, noise of the
/// pose included, with this over 3 ms times the spring's own answer. Longer is a buzzer.
inline constexpr double kLongestCouplingTime = 0.005;

/// What may differ from tool to tool, and change while the loop runs; ranges as in StepConfig. Plain: it crosses threads.
struct ToolSettings {
  double tip_radius{0.005};  ///< R, m
  LiveParameters live{};     ///< youngs_modulus is the organ's: the same for all tools
  double rendered_stiffness{std::numeric_limits<double>::infinity()};

  [[nodiscard]] bool operator==(const ToolSettings&) const = default;
};
using AllToolSettings = std::array<ToolSettings, kMaxTools>;  ///< by tool

/// Parameters of the tick. Checked once, before the loop. Infinity switches off what it bounds.
struct StepConfig {
  double tip_radius{0.005};     ///< R, m, in [0, 0.05]
  double force_limit{3.3};      ///< largest |force|, N, in [0.01, 50] or infinity (3.3: a Touch)
  double stale_timeout{0.020};  ///< s without a good pose until the ramp starts, in [0.001, 0.045]
  double zero_after{
      0.050};  ///< s without a good pose until the force is zero, in [stale_timeout + 0.001, 0.050]
  double ramp_time{
      0.030};  ///< s to full force when a pose comes (back), and to bridge a jump, in [0, 1]; 0: none
  double quaternion_tolerance{0.01};  ///< largest | |q| - 1 |, in [1e-9, 0.1]
  double friction{
      0.3};  ///< Coulomb coefficient mu, in [0, 2], or infinity: an anchor that sticks never slides
  /// K_vc of the virtual coupling, N/m, in [1, 1e5], or infinity: the tool holds the patch itself
  double coupling_stiffness{std::numeric_limits<double>::infinity()};
  /// The coupling is softer than that where it has to be, so that it and the organ in series render at most this, N/m, in
  /// [1, 1e5] or infinity: it is not (coupling_choice.h)
  double rendered_stiffness{std::numeric_limits<double>::infinity()};
  /// K_max of the organ at the model's own E, N/m, above 0 (largestStiffness()); infinity: not known, as of a rigid organ
  double organ_stiffness{std::numeric_limits<double>::infinity()};
  /// of the coupling's stretch, N s/m, in [0, 100], at most kLongestCouplingTime of the softest K_vc; unused where neither
  /// coupling_stiffness nor rendered_stiffness bounds it
  double coupling_damping{0.0};
  double force_rate_limit{std::numeric_limits<double>::infinity()};  ///< N/s, in [10, 1e6] or infinity
  double speed_limit{2.0};  ///< of a tool; faster is a jump, m/s, in [0.01, 100] or infinity
  double youngs_modulus{
      0.0};      ///< E, Pa, in [100, 1e9]; 0: the model's own. Forces scale with it (docs/design.md, Series)
  int tools{4};  ///< tools that are answered, in [1, kMaxTools]
  /// Settings of the tools that differ from those above; their youngs_modulus is not looked at
  std::array<std::optional<ToolSettings>, kMaxTools> own{};
};

/// @return the first field out of its range, with its value and the range; a damping that is too much for the coupling
/// with both numbers
[[nodiscard]] std::optional<FieldComplaint> firstComplaint(const StepConfig& config);

/// @return the first field out of its range
[[nodiscard]] std::optional<FieldComplaint> firstComplaint(const ToolSettings& settings);

/// @throw std::invalid_argument saying what firstComplaint() found
void check(const StepConfig& config);

/// What of it may change while the loop runs, of tools without settings of their own.
[[nodiscard]] LiveParameters liveParameters(const StepConfig& config) noexcept;

/// What each tool starts with.
[[nodiscard]] AllToolSettings toolSettings(const StepConfig& config) noexcept;

}  // namespace palpate
