// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <string>

#include "palpate/server/config.h"
#include "palpate/server/parameter_book.h"

namespace palpate::server {

inline constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

inline Facts factsOf(const std::string& device) {
  Facts facts;
  facts.server_id = 6;
  facts.device.fill(device);
  facts.step = withDevice({}, device, {});
  facts.organ = {160e3, 4200.0};
  facts.step.organ_stiffness = facts.organ.largest;
  return facts;
}

// A request for one field.
inline dds::ParameterRequest request(std::uint32_t field, double value) {
  dds::ParameterRequest asked{};
  asked.request_id = 42;
  asked.tool_id = dds::kAllTools;
  asked.fields = field;
  for (double* number : {&asked.youngs_modulus, &asked.friction, &asked.coupling_stiffness,
                         &asked.coupling_damping, &asked.force_limit, &asked.force_rate_limit})
    *number = kNaN;  // what is not set is not looked at
  switch (field) {
    case dds::parameter::kYoungsModulus:
      asked.youngs_modulus = value;
      break;
    case dds::parameter::kFriction:
      asked.friction = value;
      break;
    case dds::parameter::kCouplingStiffness:
      asked.coupling_stiffness = value;
      break;
    case dds::parameter::kCouplingDamping:
      asked.coupling_damping = value;
      break;
    case dds::parameter::kForceLimit:
      asked.force_limit = value;
      break;
    default:
      asked.force_rate_limit = value;
  }
  return asked;
}

}  // namespace palpate::server
