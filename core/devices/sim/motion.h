// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "core/devices/path/path.h"
#include "core/devices/sim/mechanics.h"

namespace palpate::device {

inline constexpr double kLongestLead = 0.2;  // m

/// How the hand moves.
struct MotionOptions {
  double depth{0.003};  ///< wanted depth of the tip below the rest surface, m, in (0, 0.05]
  /// How much farther the hand goes each way because friction holds the tip back, m, in [0, kLongestLead]:
  /// leadOf(device, hand). Without it a loose hand cannot bring a device with much friction to the organ.
  double lead{0.0};
  double clearance{0.005};      ///< of the tip from the surface at the start and the end, m, in (0, 0.2]
  double drag_distance{0.015};  ///< distance along the surface, m, in (0, 0.1]
  int taps{3};                  ///< before the last tap, which is held, in [1, 1000]
  double seconds{4.0};       ///< of the whole motion, at most 3600; the hold takes the rest, at least 0.8 s
  double tip_radius{0.005};  ///< R, m, in [0, 0.05]; use the server's
};

/// The hand's path, and the part of it in which the hand rests in the organ.
struct Motion {
  Path path;
  double hold_start;  ///< s; the last rest in contact begins
  double hold_end;    ///< s; and ends
  Point surface;      ///< X, the spot on the rest surface, m
  Point normal;       ///< outward unit normal there
  double tip_radius;  ///< R, m
  double depth;       ///< MotionOptions::depth, m
};

/// c / K: lag of the tip behind a hand that moves it slowly, m.
[[nodiscard]] double leadOf(const Mechanics& device, const Hand& hand) noexcept;

/// Minimum-jerk legs at a spot of the rest surface, each motion ending in a hold and a retreat to the start:
///   press  to the surface in 0.4 s, to the depth in 0.6 s: slow contact, as palpate-tool makes it
///   drag   the same, a rest of 0.2 s, then along the surface (tangentOf the normal) in 1 s
///   tap    in and out `taps` times, 0.1 s each way, then in once more: fast contact
/// @param[in] surface, normal  X, m, and the outward unit normal there
/// @throw std::invalid_argument  another kind, or a field out of its range, which it names; the least `seconds` is the
/// duration of the legs plus 0.8 s
[[nodiscard]] Motion makeMotion(const std::string& kind, const Point& surface, const Point& normal,
                                const MotionOptions& options);

}  // namespace palpate::device
