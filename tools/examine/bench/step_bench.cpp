// SPDX-License-Identifier: Apache-2.0
#include "tools/examine/bench/step_bench.h"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <vector>

#include "core/tick/shown_surface.h"
#include "core/tick/step.h"
#include "tools/examine/bench/ways.h"

namespace palpate::bench {

namespace {

constexpr double kDepth = 0.002, kPress = 0.001, kLength = 0.02;  // m
constexpr int kWays = 20;
using Ways = std::vector<std::vector<Vec3>>;

/// One tick per millisecond; tool k is on path `first` + k.
void play(const MetaModel& model, const StepConfig& config, const Ways& ways, std::size_t first, int tools,
          StepTimes& out) {
  Workspace work(model, config);
  ShownSurface surface(model);
  StepInput input;
  StepResult result;
  std::size_t ticks = ways[first].size(), touched = 0;
  for (int k = 0; k < tools; ++k)
    ticks = std::min(ticks, ways[(first + static_cast<std::size_t>(k)) % ways.size()].size());
  for (std::size_t t = 0; t < ticks; ++t) {
    for (int k = 0; k < tools; ++k) {
      const Vec3& c = ways[(first + static_cast<std::size_t>(k)) % ways.size()][t];
      input.tools[static_cast<std::size_t>(k)].present = 1;
      input.tools[static_cast<std::size_t>(k)].position = {c.x(), c.y(), c.z()};
    }
    out.samples.time([&] { benchmark::DoNotOptimize(step(model, work, input, result)); });
    out.fields.time([&] { benchmark::DoNotOptimize(surface.show(work.surface())); });
    const bool all = std::all_of(result.tools.begin(), result.tools.begin() + tools,
                                 [](const ToolResult& tool) { return (tool.flags & kInContact) != 0; });
    touched += all ? 1 : 0;
  }
  out.in_contact += static_cast<double>(touched) / static_cast<double>(ticks * ways.size());
}

void stepDefault(benchmark::State& state, const MetaModel& model, int tools) {
  StepTimes all;
  for (auto _ : state) {
    StepTimes pass = timeSteps(model, tools, kWays, kLength);
    all.samples.add(pass.samples);
    all.fields.add(pass.fields);
    all.in_contact = pass.in_contact;
  }
  all.samples.report(state);
  state.SetItemsProcessed(static_cast<std::int64_t>(all.samples.count()));
  state.counters["in_contact"] = all.in_contact;
  state.counters["field_p50_us"] = all.fields.quantile(0.5);
  state.counters["field_p99_us"] = all.fields.quantile(0.99);
  state.counters["bytes"] = static_cast<double>(model.view().modes_X.size_bytes());
}

}  // namespace

StepTimes timeSteps(const MetaModel& model, int tools, int ways, double length) {
  StepConfig config;
  config.friction = 0.3;
  const Ways all = waysOver(model, {kDepth, kPress, config.tip_radius, ways, length});
  StepTimes out;
  for (std::size_t first = 0; first < all.size(); ++first) play(model, config, all, first, tools, out);
  return out;
}

void registerSteps(const MetaModel& model) {
  const auto add = [&model](const char* name, int tools) {
    benchmark::RegisterBenchmark(name, [&model, tools](benchmark::State& state) {
      stepDefault(state, model, tools);
    })->Unit(benchmark::kMillisecond);
  };
  add("step/default/one_tool", 1);
  add("step/default/two_tools", 2);
  add("step/default/four_tools", 4);
}

}  // namespace palpate::bench
