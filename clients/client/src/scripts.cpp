// SPDX-License-Identifier: Apache-2.0
#include "palpate/client/scripts.h"

#include <cmath>
#include <sstream>

#include "palpate/client/error.h"

namespace palpate::client {
namespace {

void inRange(const char* name, double value, double above, double upto) {
  if (value > above && value <= upto) return;
  std::ostringstream line;
  line << name << " is " << value << ", expected above " << above << " and at most " << upto;
  throw ClientError(line.str());
}

}  // namespace

void check(const ScriptOptions& options) {
  if (!(options.tip_radius >= 0.0 && options.tip_radius <= 0.05))
    throw ClientError("tip radius is " + std::to_string(options.tip_radius) + " m, expected 0 to 0.05");
  inRange("depth (m)", options.depth, 0.0, 0.05);
  inRange("clearance (m)", options.clearance, 0.0, 0.2);
  inRange("slide distance (m)", options.slide_distance, 0.0, 0.1);
  inRange("number of pokes", options.pokes, 0, 10000);
}

device::Path scriptedPath(const std::string& script, const Spot& spot, const ScriptOptions& options) {
  check(options);
  const auto above = [&](double height) {
    return spot.position + (options.tip_radius + height) * spot.normal;
  };
  const device::Point start = above(options.clearance);
  const device::Point touch = above(0.0);
  const device::Point deep = above(-options.depth);
  if (script == "press")
    return device::Path(
        start,
        {{touch, 0.8, "approach"}, {deep, 1.0, "press"}, {deep, 0.6, "hold"}, {start, 0.6, "retreat"}});
  if (script == "slide") {
    const device::Point along = options.slide_distance * device::tangentOf(spot.normal);
    return device::Path(start, {{touch, 0.8, "approach"},
                                {deep, 0.7, "press"},
                                {deep + along, 1.4, "slide"},
                                {start + along, 0.6, "retreat"}});
  }
  if (script == "poke") {
    std::vector<device::Leg> legs{{touch, 0.8, "approach"}};
    for (int i = 0; i < options.pokes; ++i) {
      legs.push_back({deep, 0.15, "in"});
      legs.push_back({touch, 0.15, "out"});
    }
    legs.push_back({start, 0.7, "retreat"});
    return device::Path(start, std::move(legs));
  }
  throw ClientError("unknown script '" + script + "', expected press, slide or poke");
}

}  // namespace palpate::client
