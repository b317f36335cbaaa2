// SPDX-License-Identifier: Apache-2.0
#include "core/devices/sim/motion.h"

#include <stdexcept>

#include "core/devices/path/in_range.h"

namespace palpate::device {
namespace {

constexpr double kShortestHold = 0.8;  // s; the oscillation is judged from 0.5 s on
constexpr double kRetreat = 0.2;       // s

void check(const MotionOptions& options) {
  constexpr double kLeast = 1e-6;  // m
  requireRange("depth (m)", options.depth, kLeast, 0.05);
  requireRange("lead (m)", options.lead, 0.0, kLongestLead);
  requireRange("clearance (m)", options.clearance, kLeast, 0.2);
  requireRange("drag distance (m)", options.drag_distance, kLeast, 0.1);
  requireRange("number of taps", options.taps, 1, 1000);
  requireRange("tip radius (m)", options.tip_radius, 0.0, 0.05);
}

}  // namespace

double leadOf(const Mechanics& device, const Hand& hand) noexcept {
  return device.friction / hand.stiffness;
}

Motion makeMotion(const std::string& kind, const Point& surface, const Point& normal,
                  const MotionOptions& options) {
  check(options);
  const Point start = surface + (options.tip_radius + options.clearance + options.lead) * normal;
  const Point deep = surface + (options.tip_radius - options.depth - options.lead) * normal;
  const Point touch = surface + (options.tip_radius - options.lead) * normal;
  std::vector<Leg> legs;
  Point rest = deep;
  if (kind == "press" || kind == "drag") {
    legs.push_back({touch, 0.4, "approach"});
    legs.push_back({deep, 0.6, "press"});
  } else if (kind == "tap") {
    for (int i = 0; i < options.taps; ++i) {
      legs.push_back({deep, 0.1, "in"});
      legs.push_back({start, 0.1, "out"});
    }
    legs.push_back({deep, 0.1, "in"});
  } else {
    throw std::invalid_argument("unknown motion '" + kind + "', expected press, drag or tap");
  }
  if (kind == "drag") {
    rest = deep + options.drag_distance * tangentOf(normal);
    legs.push_back({deep, 0.2, "rest"});
    legs.push_back({rest, 1.0, "drag"});
  }
  double hold_start = 0.0;
  for (const Leg& leg : legs) hold_start += leg.seconds;
  requireRange("seconds", options.seconds, hold_start + kShortestHold + kRetreat, 3600.0);
  const double hold_end = options.seconds - kRetreat;
  legs.push_back({rest, hold_end - hold_start, "hold"});
  legs.push_back({start, kRetreat, "retreat"});
  Path path(start, std::move(legs));
  return {std::move(path), hold_start, hold_end, surface, normal, options.tip_radius, options.depth};
}

}  // namespace palpate::device
