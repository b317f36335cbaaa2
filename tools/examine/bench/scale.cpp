// SPDX-License-Identifier: Apache-2.0
#include "tools/examine/bench/scale.h"

#include <cstdio>

#include "tools/examine/bench/scratch_model.h"
#include "tools/examine/bench/step_bench.h"
#include "tools/examine/bench/synthetic_model.h"

namespace palpate::bench {

namespace {

constexpr double kPeriod = 1000.0;  // us
constexpr int kStart = 20000, kMost = 100000, kFewest = 500;
constexpr int kPositions = 1000;

/// Prints one line. @return whether its fields fit
bool fits(int nodes, int modes) {
  constexpr int kWays = 6;
  constexpr double kLength = 0.01;  // m
  const MetaModel model = throughFile(syntheticModel({nodes, modes, kPositions}));
  const StepTimes times = timeSteps(model, 1, kWays, kLength);
  const auto bytes = static_cast<double>(model.view().modes_X.size_bytes());
  const bool good = times.fields.quantile(0.99) < kPeriod;
  const double near_nodes =
      static_cast<double>(model.view().near_node.size()) / static_cast<double>(model.view().positions());
  std::printf("%9d %6d %11.1f %11.0f %9.1f %9.1f %11.2f  %s\n", nodes, modes, 1e-6 * bytes, near_nodes,
              times.fields.quantile(0.5), times.fields.quantile(0.99), times.in_contact,
              good ? "fits" : "too slow");
  std::fflush(stdout);
  return good;
}

}  // namespace

bool printScale(int modes) {
  std::printf("the field of one tool, far and near, on one core; a period at 1 kHz is %.0f us\n", kPeriod);
  std::printf("    nodes  modes  modes / MB  near nodes  p50 / us  p99 / us  in contact\n");
  int nodes = kStart, largest = 0;
  if (fits(nodes, modes)) {
    do {
      largest = nodes;
      nodes = nodes * 5 / 4;
    } while (nodes <= kMost && fits(nodes, modes));
  } else {
    do {
      nodes = nodes * 4 / 5;
    } while (nodes >= kFewest && !fits(nodes, modes));
    if (nodes >= kFewest) largest = nodes;
  }
  if (largest > 0)
    std::printf("largest at 1 kHz: %d surface nodes x %d modes with near field\n", largest, modes);
  else
    std::printf("none fits 1 kHz\n");
  return largest > 0;
}

}  // namespace palpate::bench
