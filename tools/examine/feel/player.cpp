// SPDX-License-Identifier: Apache-2.0
#include "tools/examine/feel/player.h"

#include <limits>

namespace palpate::feel {

const ToolResult& Player::at(const Vec3& c) {
  input_.tools[0].present = 1;
  input_.tools[0].age_ns = 0;
  input_.tools[0].position = {c.x(), c.y(), c.z()};
  (void)step(model_, work_, input_, result_);
  return result_.tools[0];
}

const ToolResult& Player::again() {
  input_.tools[0].age_ns += input_.dt_ns;
  (void)step(model_, work_, input_, result_);
  return result_.tools[0];
}

Vec3 forceOf(const ToolResult& result) {
  return {result.force[0], result.force[1], result.force[2]};
}

StepConfig bareContact(double friction) {
  constexpr double kOff = std::numeric_limits<double>::infinity();
  StepConfig config;
  config.friction = friction;
  config.force_limit = kOff;
  config.force_rate_limit = kOff;
  config.speed_limit = kOff;
  config.coupling_stiffness = kOff;
  config.ramp_time = 0.0;
  return config;
}

}  // namespace palpate::feel
