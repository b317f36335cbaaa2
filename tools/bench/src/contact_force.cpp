// SPDX-License-Identifier: Apache-2.0
#include "contact_force.h"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "palpate/core/contact_solver.h"
#include "palpate/core/coupling_damper.h"
#include "palpate/core/force_limiter.h"
#include "palpate/feel/surface_path.h"

namespace palpate::bench {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kTick = 1e-3;  // s

/// How the tool moves and what holds it.
struct State {
  const char* name;
  double depth;     ///< of the tip below the surface, m; below 0: above it
  double friction;  ///< mu
  double coupling;  ///< K_vc, N/m
};

constexpr State kStates[] = {
    {"free_far", -0.05, 0.3, kInfinity},    {"free_near", -0.001, 0.3, kInfinity},
    {"stick", 0.002, kInfinity, kInfinity}, {"stick_coupled", 0.002, kInfinity, 300.0},
    {"slide", 0.002, 0.0, kInfinity},       {"slide_friction", 0.002, 0.3, kInfinity},
    {"slide_coupled", 0.002, 0.3, 300.0},   {"beyond_domain", 0.015, 0.3, kInfinity},
};

/// Tip centres along random smooth slides, each reached from above.
std::vector<std::vector<Vec3>> waysOver(const MetaModel& model, const State& state, double tip_radius) {
  constexpr int kWays = 20;
  constexpr double kSpeed = 0.05, kLength = 0.02;  // m/s, m
  std::mt19937 random(1);
  std::vector<std::vector<Vec3>> ways;
  while (ways.size() < kWays) {
    const auto path = feel::randomPath(model, kSpeed * kTick, kLength, random);
    if (!path) continue;
    std::vector<Vec3>& way = ways.emplace_back();
    const auto above = [&](const feel::PathPoint& p, double depth) {
      way.push_back(p.position + (tip_radius - depth) * p.normal);
    };
    for (double depth = -5e-4; depth < state.depth; depth += kSpeed * kTick) above(path->front(), depth);
    for (const feel::PathPoint& point : *path) above(point, state.depth);
  }
  return ways;
}

double quantile(std::vector<double>& sorted, double q) {
  return sorted[static_cast<std::size_t>(q * static_cast<double>(sorted.size() - 1))];
}

void contactForce(benchmark::State& benchmark, const MetaModel& model, const State& state) {
  using Clock = std::chrono::steady_clock;
  const StepConfig config;
  const ContactSolver solver(config.tip_radius);
  const ForceLimiter limiter(config);
  const ContactLaw law{state.friction, 1.0 / state.coupling, 1.0};
  const std::vector<std::vector<Vec3>> ways = waysOver(model, state, config.tip_radius);
  std::vector<double> us;
  for (auto _ : benchmark) {
    for (const std::vector<Vec3>& way : ways) {
      Contact contact;
      CouplingDamper damper;
      Rendering rendering;
      for (const Vec3& c : way) {
        const auto start = Clock::now();
        solver.update(model, law, c, contact);
        LimiterInput in;
        in.force = -damper.force(contact, 0.003, kTick);
        in.stiffness = -contact.stiffness;
        in.dt = in.period = kTick;
        in.jumped = contact.jumped;
        benchmark::DoNotOptimize(limiter.limit(in, rendering));
        us.push_back(std::chrono::duration<double, std::micro>(Clock::now() - start).count());
      }
    }
  }
  std::sort(us.begin(), us.end());
  benchmark.SetItemsProcessed(static_cast<std::int64_t>(us.size()));
  benchmark.counters["p50_us"] = quantile(us, 0.5);
  benchmark.counters["p99_us"] = quantile(us, 0.99);
}

}  // namespace

void registerContactForce(const MetaModel& model) {
  for (const State& state : kStates)
    benchmark::RegisterBenchmark((std::string("contact_force/") + state.name).c_str(),
                                 [&model, &state](benchmark::State& b) { contactForce(b, model, state); });
}

}  // namespace palpate::bench
