// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "core/devices/path/path.h"
#include "palpate/client/surface.h"

namespace palpate::client {

/// How a scripted tool touches the organ.
struct ScriptOptions {
  double tip_radius{0.005};  ///< R, m, in [0, 0.05]; take the server's
  double depth{0.003};       ///< depth of the tip below the rest surface, m, in (0, 0.05]
  double clearance{0.010};  ///< distance of the tip from the surface at the start and the end, m, in (0, 0.2]
  double slide_distance{0.01};  ///< distance along the surface, m, in (0, 0.1]
  int pokes{4};                 ///< number of times that `poke` goes in, in [1, 10000]
};

/// @throw ClientError naming the first field out of range, its value and the range
void check(const ScriptOptions& options);

/// Path of the tip's centre for a script:
///   press  approach along the normal, press to the depth, hold, retreat      3.0 s
///   slide  approach, press, move tangentially, retreat                       3.5 s
///   poke   approach, then quickly in and out several times, retreat          1.5 s + 0.3 s each
/// @throw ClientError for another name
[[nodiscard]] device::Path scriptedPath(const std::string& script, const Spot& spot,
                                        const ScriptOptions& options);

}  // namespace palpate::client
