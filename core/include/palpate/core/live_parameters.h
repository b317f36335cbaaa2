// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <type_traits>

#include "palpate/live_parameter_list.h"  // made from palpate.idl, the only list of them

namespace palpate {

/// Parameters of the tick that may change while it runs; meaning and ranges as in StepConfig. Plain: it crosses
/// threads. A change is never a step of the force: step() blends over to the new values within LiveBlend::kSeconds, and
/// where no numbers lie between, it blends the force over (LiveBlend).
using LiveParameters = LiveFields<double>;

/// @return one sentence about the first field out of its range, "friction is 3, expected 0 to 2", or about a damping that is
/// too much for the coupling (kLongestCouplingTime); empty: all good
[[nodiscard]] std::string firstComplaint(const LiveParameters& parameters);

static_assert(std::is_trivially_copyable_v<LiveParameters>);

}  // namespace palpate
