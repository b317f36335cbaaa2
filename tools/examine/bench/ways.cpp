// SPDX-License-Identifier: Apache-2.0
#include "tools/examine/bench/ways.h"

#include <cmath>
#include <numbers>
#include <random>
#include <stdexcept>

#include "tools/examine/feel/surface_path.h"

namespace palpate::bench {

namespace {

constexpr double kStep = 5e-5;  // m, in a millisecond

std::vector<Vec3> wayAlong(const std::vector<feel::PathPoint>& path, const WayOptions& options) {
  std::vector<Vec3> way;
  const auto above = [&](const feel::PathPoint& p, double depth) {
    way.push_back(p.position + (options.tip_radius - depth) * p.normal);
  };
  for (double depth = -5e-4; depth < options.depth; depth += kStep) above(path.front(), depth);
  for (std::size_t i = 0; i < path.size(); ++i) {
    const double turns = 2.0 * static_cast<double>(i) / static_cast<double>(path.size());
    above(path[i], options.depth + options.press * std::sin(2.0 * std::numbers::pi * turns));
  }
  return way;
}

}  // namespace

std::vector<std::vector<Vec3>> waysOver(const MetaModel& model, const WayOptions& options) {
  constexpr int kMostTries = 2000;
  std::mt19937 random(1);
  std::vector<std::vector<Vec3>> ways;
  for (int tries = 0; ways.size() < static_cast<std::size_t>(options.ways); ++tries) {
    if (tries == kMostTries)
      throw std::runtime_error("the accessible part of " + model.id() + " has no room for slides of " +
                               std::to_string(1e3 * options.length) + " mm");
    if (const auto path =
            feel::randomPath(model, options.tip_radius - options.depth, kStep, options.length, random))
      ways.push_back(wayAlong(*path, options));
  }
  return ways;
}

}  // namespace palpate::bench
