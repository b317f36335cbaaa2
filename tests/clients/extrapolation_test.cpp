// SPDX-License-Identifier: Apache-2.0
// The gain of extrapolation for a device at 4 kHz beside a server at 1 kHz. No wall clock: time is counted.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <deque>
#include <limits>

#include "../core/driver.h"
#include "force_renderer.h"

namespace palpate::haptic {
namespace {

constexpr int kRate = 4;                   // device periods in a tick of the server
constexpr std::int64_t kPeriod = 250'000;  // ns, of the device
constexpr int kWay =
    2;  // device periods from a tick to its answer at the device: 0.5 ms, a round trip over DDS

StepConfig unlimited() {
  StepConfig config;
  config.force_limit = std::numeric_limits<double>::infinity();
  config.friction = std::numeric_limits<double>::infinity();
  config.ramp_time = 0.0;
  return config;
}

// Down by 6 mm and up again in 0.1 s: 0.23 m/s at most, at the top of the round organ and somewhat sideways.
Point pressAt(double t) {
  const double down = t < 0.05 ? device::minimumJerk(t / 0.05) : device::minimumJerk((0.1 - t) / 0.05);
  return {0.0015 * down, 0.0, 0.0555 - 0.006 * down};
}

Answer answerOf(const ToolResult& result, std::uint64_t seq, std::int64_t now) {
  return {result.force, result.stiffness, result.anchor, result.proxy, seq, result.flags, result.state, now};
}

struct Errors {
  double held{0.0};
  double carried{0.0};
  double largest_held{0.0};
  double largest_carried{0.0};
  double largest_force{0.0};
  int count{0};
  void add(const Vec3& truth, const Vec3& hold, const Vec3& carry) {
    const auto distance = [](const Vec3& a, const Vec3& b) {
      return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
    };
    const double h = distance(truth, hold), c = distance(truth, carry);
    held += h * h;
    carried += c * c;
    largest_held = std::max(largest_held, h);
    largest_carried = std::max(largest_carried, c);
    largest_force = std::max(largest_force, std::hypot(truth[0], truth[1], truth[2]));
    ++count;
  }
};

Errors play() {
  const MetaModel model = palpate::testing::loadSynthetic();
  palpate::testing::Driver server(model, unlimited()), truth(model, unlimited());
  ForceRenderer holding(0.002), carrying(0.002);
  std::deque<std::pair<std::int64_t, Answer>> on_the_way;
  Errors errors;
  for (int i = 0; i < 40 * kRate + 400; ++i) {
    const std::int64_t now = i * kPeriod + 1'000'000;
    // 40 ms at rest above the organ first, so that the watchdog passes the full force.
    const Point p = pressAt(std::max(0.0, 1e-9 * static_cast<double>(now) - 0.041));
    const Vec3 true_force = truth.at(palpate::Vec3(p[0], p[1], p[2])).force;
    const auto seq = static_cast<std::uint64_t>(i + 1);
    for (ForceRenderer* renderer : {&holding, &carrying}) renderer->sent(seq, p, now);
    if (i % kRate == 0)
      on_the_way.emplace_back(now + kWay * kPeriod,
                              answerOf(server.at(palpate::Vec3(p[0], p[1], p[2])), seq, now));
    while (!on_the_way.empty() && on_the_way.front().first <= now) {
      for (ForceRenderer* renderer : {&holding, &carrying}) renderer->answered(on_the_way.front().second);
      on_the_way.pop_front();
    }
    const Vec3 hold = holding.at(nullptr, now, 1e3).force;
    const Vec3 carry = carrying.at(&p, now, 1e3).force;
    if (i >= 40 * kRate) errors.add(true_force, hold, carry);
  }
  return errors;
}

TEST(Extrapolation, SavesTwoThirdsOfTheErrorOfHoldingAt4kHz) {
  const Errors errors = play();
  const double held = std::sqrt(errors.held / errors.count),
               carried = std::sqrt(errors.carried / errors.count);
  std::printf(
      "fast press to %.2f N, device at 4 kHz, server at 1 kHz, answers 0.5 ms on the way\n"
      "force error, rms: held %.4f N, extrapolated %.4f N; largest: held %.4f N, extrapolated %.4f N\n",
      errors.largest_force, held, carried, errors.largest_held, errors.largest_carried);
  EXPECT_GT(held, 0.01 * errors.largest_force) << "the press is fast enough to tell";
  EXPECT_LE(carried, held / 3.0);
}

}  // namespace
}  // namespace palpate::haptic
