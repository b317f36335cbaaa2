// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/model/meta_model.h"
#include "tools/examine/bench/samples.h"

namespace palpate::bench {

/// Times of ticks of step(), and of the surface that each hands over, while tools press and slide over random
/// paths, 1 to 3 mm deep, with mu = 0.3. There is no virtual coupling, since it would take a part of
/// the depth.
struct StepTimes {
  Samples samples;
  Samples fields;          ///< ShownSurface::show(): near and far field
  double in_contact{0.0};  ///< share of the ticks in which every tool touched the organ
};

/// @param[in] tools  1 to 4, each on its own path  @param[in] ways paths to play, of `length` m each
[[nodiscard]] StepTimes timeSteps(const MetaModel& model, int tools, int ways, double length);

/// Registers step/default/one_tool, two_tools and four_tools. `model` must live until the benchmarks have run.
void registerSteps(const MetaModel& model);

}  // namespace palpate::bench
