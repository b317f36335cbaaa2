// SPDX-License-Identifier: Apache-2.0
#include "tools/examine/bench/cadence_bench.h"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "core/tick/step.h"
#include "palpate/rt/clock.h"
#include "palpate/rt/periodic_thread.h"
#include "tools/examine/bench/scratch_model.h"
#include "tools/examine/bench/synthetic_model.h"
#include "tools/examine/bench/ways.h"

namespace palpate::bench {

namespace {

using Way = std::vector<Vec3>;

constexpr double kDepth = 0.002, kPress = 0.001;  // m
constexpr double kFriction = 0.3;
constexpr double kWayRate = 1000.0;  // Hz, of the points of a way

/// Fills first and second level cache with something else, as the threads do that send: 4 MB a millisecond.
class OtherWork {
 public:
  explicit OtherWork(double rate_hz)
      : lines_(static_cast<std::size_t>(kLines * std::min(1.0, 1000.0 / rate_hz))) {}

  /// In one period.
  void run() noexcept {
    for (std::size_t i = 0; i < lines_; ++i, next_ = (next_ + 1) % kLines) ++bytes_[kLine * next_];
    benchmark::ClobberMemory();
  }

 private:
  static constexpr std::size_t kLine = 64, kLines = (4U << 20U) / kLine;
  std::size_t lines_, next_{0};
  std::vector<unsigned char> bytes_ = std::vector<unsigned char>(kLine * kLines);
};

Vec3 pointAt(const Way& way, double place) {
  const auto i = std::min(static_cast<std::size_t>(place), way.size() - 2);
  const double share = place - static_cast<double>(i);
  return (1.0 - share) * way[i] + share * way[i + 1];
}

/// The step of a tick ago, as the server's loop rehearses it.
struct LastStep {
  const MetaModel& model;
  Workspace work;
  StepInput input;
  StepResult result;

  static void rehearse(void* context) noexcept PALPATE_NONBLOCKING {
    auto& last = *static_cast<LastStep*>(context);
    benchmark::DoNotOptimize(step(last.model, last.work, last.input, last.result));
  }
};

void play(const MetaModel& model, const StepConfig& config, const Way& way, const Cadence& cadence,
          OtherWork& other, StepTimes& out, std::size_t& ticks) {
  Workspace work(model, config);
  StepInput input;
  StepResult result;
  input.tools[0].present = 1;
  input.dt_ns = input.period_ns = std::llround(1e9 / cadence.rate_hz);
  LastStep last{model, Workspace(model, config), input, {}};
  rt::Rehearsal rehearsal;
  if (cadence.rehearsed) rehearsal = {&LastStep::rehearse, &last, rt::rehearsalLead(input.period_ns)};
  std::int64_t next_ns = rt::monotonicNow(), previous_ns = 0;
  for (double place = 0.0; place < static_cast<double>(way.size() - 1); place += kWayRate / cadence.rate_hz) {
    const Vec3 c = pointAt(way, place);
    input.tools[0].position = {c.x(), c.y(), c.z()};
    other.run();
    next_ns = std::max(next_ns + input.period_ns, rt::monotonicNow());
    (void)rt::awaitDeadline(next_ns, rehearsal, previous_ns);
    Samples one;
    one.time([&] { benchmark::DoNotOptimize(step(model, work, input, result)); });
    last.input = input;
    previous_ns = std::llround(1e3 * one.sum());
    ++ticks;
    if ((result.tools[0].flags & kInContact) != 0) out.samples.add(one);
  }
}

void atCadence(benchmark::State& state, const MetaModel& model, const Cadence& cadence) {
  StepTimes times;
  for (auto _ : state) times = timeAtCadence(model, cadence);
  times.samples.report(state);
  state.SetItemsProcessed(static_cast<std::int64_t>(times.samples.count()));
  state.counters["in_contact"] = times.in_contact;
}

double medianOf(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

void growth(benchmark::State& state, double rate_hz) {
  constexpr int kAlternations = 5, kModes = 100, kPositions = 1000;
  constexpr std::array kNodes{2000, 20000};
  const std::array models{throughFile(syntheticModel({kNodes[0], kModes, kPositions})),
                          throughFile(syntheticModel({kNodes[1], kModes, kPositions}))};
  std::array<std::vector<double>, 2> p50, p99;
  for (auto _ : state)
    for (int turn = 0; turn < kAlternations; ++turn)
      for (std::size_t size = 0; size < models.size(); ++size) {
        const StepTimes times = timeAtCadence(models[size], {rate_hz, Cadence{}.coupling, 6, 0.02});
        p50[size].push_back(times.samples.quantile(0.5));
        p99[size].push_back(times.samples.quantile(0.99));
      }
  for (std::size_t size = 0; size < models.size(); ++size) {
    const std::string name = std::to_string(kNodes[size]);
    state.counters["p50_us_" + name] = medianOf(p50[size]);
    state.counters["p99_us_" + name] = medianOf(p99[size]);
  }
  state.counters["p50_ratio"] = medianOf(p50[1]) / medianOf(p50[0]);
  state.counters["p99_ratio"] = medianOf(p99[1]) / medianOf(p99[0]);
}

}  // namespace

StepTimes timeAtCadence(const MetaModel& model, const Cadence& cadence) {
  StepConfig config;
  config.friction = kFriction;
  config.coupling_stiffness = cadence.coupling;
  OtherWork other(cadence.rate_hz);
  StepTimes out;
  std::size_t ticks = 0;
  for (const Way& way : waysOver(model, {kDepth, kPress, config.tip_radius, cadence.ways, cadence.length}))
    play(model, config, way, cadence, other, out, ticks);
  out.in_contact = static_cast<double>(out.samples.count()) / static_cast<double>(ticks);
  return out;
}

void registerCadence(const MetaModel& model, double rate_hz) {
  constexpr double kCoupling = 300.0;                                                 // N/m, a Touch
  const int ways = std::max(2, static_cast<int>(Cadence{}.ways * 1000.0 / rate_hz));  // 8 s of ticks
  const auto add = [&](const char* name, Cadence cadence) {
    cadence.rate_hz = rate_hz;
    cadence.ways = ways;
    benchmark::RegisterBenchmark(
        name, [&model, cadence](benchmark::State& state) { atCadence(state, model, cadence); })
        ->Unit(benchmark::kMillisecond)
        ->Iterations(1);
  };
  Cadence coupled, unrehearsed;
  coupled.coupling = kCoupling;
  unrehearsed.rehearsed = false;
  add("cadence/default/friction", {});
  add("cadence/default/friction_coupled", coupled);
  add("cadence/default/friction_unrehearsed", unrehearsed);
}

void registerGrowth(double rate_hz) {
  benchmark::RegisterBenchmark("growth/20000_over_2000",
                               [rate_hz](benchmark::State& state) { growth(state, rate_hz); })
      ->Unit(benchmark::kMillisecond)
      ->Iterations(1);
}

}  // namespace palpate::bench
