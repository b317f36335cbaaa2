// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "core/devices/path/path.h"
#include "core/devices/sim/held_device.h"
#include "core/devices/sim/motion.h"

namespace palpate::device {

/// Positions of the tip and the forces on it, at even steps of time.
struct Trace {
  double dt{1e-3};                   ///< s between two entries, above 0
  std::vector<Point> position;       ///< n tip positions; entry i at time i dt, m
  std::vector<Point> force;          ///< n forces on the tool that acted until then, N
  std::vector<AlongForce> energy{};  ///< n sums until then; may be empty where nobody judges it
  std::vector<bool> stalled{};  ///< n: the machine stood still before the step to the entry; empty: never
};

/// Motion of the tip about its slow trend, after the time to settle.
struct Oscillation {
  double pp{0.0};  ///< peak to peak on the axis that moves most, m
  bool growing{
      false};  ///< the second half of the time is larger than 1.2 times the first and the noise floor
  double seconds{0.0};  ///< that were judged
  bool enough{true};    ///< at least 1 s of them, or half of the time that the hold has for it
};

/// Oscillations below this do not count. It is the finest nominal position resolution of the presets' devices (0.02 mm,
/// Premium 3.0): none of them could show less.
inline constexpr double kNoiseFloor = 20e-6;  // m

/// The trace in the hold, from 0.5 s after its start to 0.125 s before its end, less its running mean over 0.25 s. After a
/// stall, which moves the tip as a blow would, as after the start: each stretch between stalls is judged alone, from 0.5 s on,
/// where at least 0.15 s of it are left. The largest pp counts, and whether one grows.
/// A trace counts as growing when it ends earlier, or holds a number that is not finite or beyond 10 m.
[[nodiscard]] Oscillation oscillationIn(const Trace& trace, const Motion& motion);

/// Time from the start of the hold until the tip stays near its end position (mean of the last 0.25 s of the hold), s:
/// within 5 % of the imposed depth, or within the noise floor where that is larger. Nothing when it never does.
[[nodiscard]] std::optional<double> settleTime(const Trace& trace, const Motion& motion);

/// Judgement of a run in contact with the organ, beside the same run without it.
struct Verdict {
  bool judged{false};  ///< Oscillation::enough. Without it nothing is known of the loop
  bool stable{false};  ///< judged, not growing, and the oscillation at most twice that without the organ plus
                       ///< kNoiseFloor
  double judged_s{0.0};
  std::optional<double> settle_s;
  double oscillation_pp{0.0};                ///< m
  double oscillation_without_organ_pp{0.0};  ///< m
  double max_force{0.0};                     ///< N
  double depth{0.0};  ///< largest distance of the tip below the rest surface at the spot, m, at least 0
};

[[nodiscard]] Verdict judge(const Trace& with_organ, const Trace& without_organ, const Motion& motion);

}  // namespace palpate::device
