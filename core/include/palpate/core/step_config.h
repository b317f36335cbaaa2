// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace palpate {

/// Parameters of the tick. Checked once, before the loop.
struct StepConfig {
  double tip_radius{0.005};     ///< R, m, in [0, 0.05]
  double force_limit{3.3};      ///< largest |force|, N, in [0.01, 50] (3.3: a Touch)
  double stale_timeout{0.020};  ///< s without a good pose until the ramp starts, in [0.001, 0.045]
  double zero_after{
      0.050};  ///< s without a good pose until the force is zero, in [stale_timeout + 0.001, 0.050]
  double ramp_time{0.030};  ///< s to full force when a pose comes (back), and to bridge a jump, in [0.001, 1]
  double quaternion_tolerance{0.01};  ///< largest | |q| - 1 |, in [1e-9, 0.1]
};

/// @throw std::invalid_argument naming the first field out of its range, its value and the range
void check(const StepConfig& config);

}  // namespace palpate
