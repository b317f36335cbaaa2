// SPDX-License-Identifier: Apache-2.0
#include "tools/examine/bench/contact_force.h"

#include <benchmark/benchmark.h>

#include <limits>
#include <string>

#include "core/contact/contact_solver.h"
#include "core/tick/coupling_damper.h"
#include "core/tick/force_limiter.h"
#include "tools/examine/bench/samples.h"
#include "tools/examine/bench/ways.h"

namespace palpate::bench {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kTick = 1e-3;  // s

/// Motion of the tool, friction and coupling.
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

void contactForce(benchmark::State& benchmark, const MetaModel& model, const State& state) {
  const StepConfig config;
  const ContactSolver solver(config.tip_radius);
  const ForceLimiter limiter(config);
  const ContactLaw law{state.friction, 1.0 / state.coupling, 1.0};
  const std::vector<std::vector<Vec3>> ways = waysOver(model, {state.depth, 0.0, config.tip_radius});
  Samples samples;
  for (auto _ : benchmark) {
    for (const std::vector<Vec3>& way : ways) {
      Contact contact;
      CouplingDamper damper;
      Rendering rendering;
      for (const Vec3& c : way) {
        samples.time([&] {
          solver.update(model, law, c, contact);
          LimiterInput in;
          in.force = -damper.force(contact, 0.003, kTick);
          in.stiffness = -contact.stiffness;
          in.dt = in.period = kTick;
          in.jumped = contact.jumped();
          benchmark::DoNotOptimize(limiter.limit(in, rendering));
        });
      }
    }
  }
  benchmark.SetItemsProcessed(static_cast<std::int64_t>(samples.count()));
  samples.report(benchmark);
}

}  // namespace

void registerContactForce(const MetaModel& model) {
  for (const State& state : kStates)
    benchmark::RegisterBenchmark((std::string("contact_force/") + state.name).c_str(),
                                 [&model, &state](benchmark::State& b) { contactForce(b, model, state); });
}

}  // namespace palpate::bench
