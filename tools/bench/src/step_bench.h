// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "palpate/core/meta_model.h"
#include "samples.h"

namespace palpate::bench {

/// Times of whole ticks of step(), contact, force, near and far field, while tools press and slide over
/// random ways: mu = 0.3, no virtual coupling, which would leave less of the depth to the organ, 1 to 3 mm
/// deep.
struct StepTimes {
  Samples samples;
  double in_contact{0.0};  ///< share of the ticks in which every tool touched the organ
};

/// @param[in] tools  1 to 4, each on a way of its own  @param[in] ways  to play, of `length` m each
[[nodiscard]] StepTimes timeSteps(const MetaModel& model, int tools, int ways, double length);

/// Registers step/default/one_tool and step/default/two_tools. `model` must live until the benchmarks have run.
void registerSteps(const MetaModel& model);

}  // namespace palpate::bench
