// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <utility>

#include "core/devices/path/path.h"
#include "core/devices/sim/delays.h"
#include "core/devices/sim/held_device.h"
#include "core/devices/sim/verdict.h"

namespace palpate::device {

/// A whole run of a held device in one thread, one pose and one force each period, as over the wire.
/// @param[in] force_at     Point(const Point& position): the force on the tool, N, that answers a pose; called in the
///                         order of time
/// @param[in] delay        periods from a pose to the first period in which its answer acts, in [0, 3]. 0: at once. 1:
///                         a driver that sends, waits for its next period and then reads
/// @param[in] period       s
/// @return one entry per period, the first at the start
template <class ForceAt>
[[nodiscard]] Trace closedLoop(HeldDevice& device, const Motion& motion, ForceAt&& force_at,
                               std::size_t delay = 1, double period = 1e-3) {
  Trace trace{period, {device.position()}, {Point{}}, {device.alongForce()}};
  std::array<Point, 4> pending{};  // answers on their way, by period
  const auto count = static_cast<std::size_t>(motion.path.seconds() / period + 0.5);
  for (std::size_t i = 0; i < count; ++i) {
    pending[(i + delay) % pending.size()] = force_at(device.position());
    const Point force = pending[i % pending.size()];
    device.step(force, period);
    trace.position.push_back(device.position());
    trace.force.push_back(force);
    trace.energy.push_back(device.alongForce());
  }
  return trace;
}

/// The same with measured delays. @param[in] force_at  Point(const Point& position, bool is_new): the answer of the tick that
/// knows this pose; not new: no pose went out, and the tick has the one before again
/// @param[in] first  period of the measurement with which the run begins
template <class ForceAt>
[[nodiscard]] Trace closedLoop(HeldDevice& device, const Motion& motion, ForceAt&& force_at,
                               const Delays& delays, std::size_t first) {
  Trace trace{Delays::kPeriod, {device.position()}, {Point{}}, {device.alongForce()}};
  std::array<Point, Delays::kStall> answers{};  // of the last periods
  Point sent = device.position();
  const auto count = static_cast<std::size_t>(motion.path.seconds() / Delays::kPeriod + 0.5);
  for (std::size_t i = 0; i < count; ++i) {
    const Delays::Period& period = delays.at(first + i);
    if (period.sends) sent = device.position();
    answers[i % answers.size()] = force_at(sent, period.sends);
    const Point force = period.lag > i ? Point{} : answers[(i - period.lag) % answers.size()];
    device.step(force, Delays::kPeriod);
    trace.position.push_back(device.position());
    trace.force.push_back(force);
    trace.energy.push_back(device.alongForce());
  }
  return trace;
}

/// The same without an organ. @param[in] device  as it was at the start of the other run
[[nodiscard]] inline Trace withoutOrgan(HeldDevice device, const Motion& motion, double period = 1e-3) {
  return closedLoop(
      device, motion, [](const Point&) { return Point{}; }, 0, period);
}

}  // namespace palpate::device
