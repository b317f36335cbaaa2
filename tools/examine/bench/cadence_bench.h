// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>

#include "core/model/meta_model.h"
#include "tools/examine/bench/step_bench.h"

namespace palpate::bench {

/// How ticks come.
struct Cadence {
  double rate_hz{1000.0};
  double coupling{std::numeric_limits<double>::infinity()};  ///< K_vc, N/m
  int ways{20};                                              ///< paths to play
  double length{0.02};                                       ///< of each, m
  bool rehearsed{true};                                      ///< as the server's ticks are
};

/// Times of ticks of one tool in friction contact, mu = 0.3, as a loop has them: the thread sleeps until each one, and in
/// between the caches fill with other things, some MB of them. Paths as in timeSteps(), at 50 mm/s at any rate.
[[nodiscard]] StepTimes timeAtCadence(const MetaModel& model, const Cadence& cadence);

/// Registers cadence/default/friction, /friction_coupled and /friction_unrehearsed. `model` must live until the benchmarks have run.
void registerCadence(const MetaModel& model, double rate_hz);

/// Registers growth/20000_over_2000: ticks of two synthetic models in turn, five times; medians, and the ratios of these.
void registerGrowth(double rate_hz);

}  // namespace palpate::bench
