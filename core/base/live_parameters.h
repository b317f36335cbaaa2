// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <type_traits>

#include "palpate/live_parameter_list.h"  // made from palpate.idl, the only list of them

namespace palpate {

/// Parameters of the tick that may change while it runs; meaning and ranges as in StepConfig. Plain: it crosses
/// threads. A change is never a step of the force: step() blends over to the new values within LiveBlend::kSeconds, and
/// where no numbers lie between, it blends the force over (LiveBlend).
using LiveParameters = LiveFields<double>;

/// What is wrong with one field of LiveParameters or StepConfig.
struct FieldComplaint {
  std::string field;  ///< e.g. "friction"
  std::string text;   ///< e.g. "is 3, expected 0 to 2"

  [[nodiscard]] std::string sentence() const { return field + " " + text; }
};

/// @param rendered_stiffness  StepConfig's. @return the first field out of its range, or a damping that is too much for the
/// coupling (kLongestCouplingTime)
[[nodiscard]] std::optional<FieldComplaint> firstComplaint(
    const LiveParameters& parameters, double rendered_stiffness = std::numeric_limits<double>::infinity());

static_assert(std::is_trivially_copyable_v<LiveParameters>);

}  // namespace palpate
