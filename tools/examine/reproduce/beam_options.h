// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

namespace palpate::reproduce {

struct BeamOptions {
  double load{1.0};       ///< N, downward, > 0
  int steps{100};         ///< load steps, >= 1
  double tolerance{0.1};  ///< relative residual at which a step ends: energy norm, worst position, > 0
  std::array<int, 3> nodes{21, 9, 9};  ///< along 400 x 40 x 40 mm, each >= 2
  int workers{1};
};

}  // namespace palpate::reproduce
