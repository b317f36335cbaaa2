// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <type_traits>

namespace palpate {

/// Parameters of the tick that may change while it runs; meaning and ranges as in StepConfig. Plain: it crosses
/// threads. A change is never a step of the force: step() goes over to the new values within LiveBlend::kSeconds, and
/// where there are no numbers on the way the force goes over (LiveBlend).
struct LiveParameters {
  double youngs_modulus{0.0};      ///< E, Pa; 0: the model's own
  double friction{0.0};            ///< mu
  double coupling_stiffness{0.0};  ///< K_vc, N/m
  double coupling_damping{0.0};    ///< N s/m
  double force_limit{0.0};         ///< N
  double force_rate_limit{0.0};    ///< N/s

  [[nodiscard]] bool operator==(const LiveParameters&) const = default;
};

/// @return one sentence about the first field out of its range, "friction is 3, expected 0 to 2", or about a damping that is
/// too much for the coupling (kLongestCouplingTime); empty: all good
[[nodiscard]] std::string firstComplaint(const LiveParameters& parameters);

static_assert(std::is_trivially_copyable_v<LiveParameters>);

}  // namespace palpate
