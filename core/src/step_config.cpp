// SPDX-License-Identifier: Apache-2.0
#include "palpate/core/step_config.h"

#include <sstream>
#include <stdexcept>

namespace palpate {

namespace {

void range(const char* field, double value, double low, double high, const char* unit) {
  if (value >= low && value <= high) return;  // false for NaN too
  std::ostringstream text;
  text << "StepConfig." << field << " is " << value << ", expected " << low << " to " << high << " " << unit;
  throw std::invalid_argument(text.str());
}

}  // namespace

void check(const StepConfig& config) {
  range("tip_radius", config.tip_radius, 0.0, 0.05, "m");
  range("force_limit", config.force_limit, 0.01, 50.0, "N");
  range("stale_timeout", config.stale_timeout, 0.001, 0.045, "s");
  range("zero_after", config.zero_after, config.stale_timeout + 0.001, 0.050, "s");
  range("ramp_time", config.ramp_time, 0.001, 1.0, "s");
  range("quaternion_tolerance", config.quaternion_tolerance, 1e-9, 0.1, "(no unit)");
}

}  // namespace palpate
