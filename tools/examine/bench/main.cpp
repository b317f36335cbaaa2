// SPDX-License-Identifier: Apache-2.0
// palpate-bench: how long the parts of a tick take.
#include <benchmark/benchmark.h>

#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <optional>
#include <string_view>

#include "palpate/rt/scheduling.h"
#include "tools/examine/bench/cadence_bench.h"
#include "tools/examine/bench/contact_force.h"
#include "tools/examine/bench/eigen_product.h"
#include "tools/examine/bench/field.h"
#include "tools/examine/bench/load_bench.h"
#include "tools/examine/bench/quiet_core.h"
#include "tools/examine/bench/scale.h"
#include "tools/examine/bench/step_bench.h"
#include "tools/program/command_line.h"
#include "tools/program/run.h"

namespace palpate::bench {
namespace {

struct Options {
  std::string model;
  int cpu{-1};
  bool realtime{false};
  bool scale{false};
  int modes{100};
  double rate_hz{1000.0};
};

/// Google Benchmark's own option, which has no getter: how long each benchmark runs, s.
double leastSeconds(int argc, char** argv) {
  constexpr std::string_view kOption = "--benchmark_min_time=";
  for (int i = 1; i < argc; ++i)
    if (std::string_view(argv[i]).starts_with(kOption)) return std::atof(argv[i] + kOption.size());
  return 0.5;
}

/// The given model, or the one of tools/demo: under this folder or where this program was built.
std::optional<std::filesystem::path> chooseModel(const Options& options) {
  if (!options.model.empty()) return options.model;
  std::error_code gone;
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", gone);
  for (const auto& path : {std::filesystem::path("build/demo/liver.h5"),
                           program.parent_path().parent_path().parent_path() / "demo/liver.h5"})
    if (std::filesystem::exists(path, gone)) return path;
  return std::nullopt;
}

int run(const Options& options, double seconds) {
  // 1. One processor, and other work that disturbs it.
  const int cpu = pinTo(options.cpu);
  std::optional<rt::CpuLatencyHold> awake;  // as the server holds it
  if (options.realtime) {
    raiseLikeTheTick();
    awake.emplace();
  }
  for (const std::string& what : disturbances(cpu)) std::cerr << "palpate-bench: " << what << "\n";
  benchmark::AddCustomContext("pinned_to_cpu", std::to_string(cpu));
  benchmark::AddCustomContext("eigen_instructions", eigenInstructions());
  if (options.scale) return printScale(options.modes) ? 0 : 1;
  // 2. The benchmarks.
  registerFields(seconds);
  registerGrowth(options.rate_hz);
  std::optional<MetaModel> model;
  if (const auto path = chooseModel(options)) {
    model.emplace(MetaModel::load(*path));
    benchmark::AddCustomContext("model", path->string());
    registerSteps(*model);
    registerCadence(*model, options.rate_hz);
    registerLoad(*path);
    registerContactForce(*model);
  } else {
    std::cerr << "palpate-bench: no model given and no build/demo/liver.h5 (tools/demo makes it): without "
                 "step/*, cadence/*, "
                 "load/* and contact_force/*\n";
  }
  // 3. Measure.
  benchmark::RunSpecifiedBenchmarks();
  return program::kDone;
}

int body(int argc, char** argv) {
  program::CommandLine line(
      "palpate-bench",
      "Measures the parts of a tick. Options that begin with --benchmark_ are Google Benchmark's own, e.g. "
      "--benchmark_format=json, --benchmark_filter=field/2009x167.");
  Options options;
  program::Options add = line.options();
  add.add("model", &options.model,
          "model file (.h5) of step/default, cadence/default, load/default and contact_force; default: "
          "build/demo/liver.h5, if "
          "there is one");
  add.add("--cpu", &options.cpu, "processor to run on; -1: the last one that may be used");
  add.flag("--realtime", &options.realtime,
           "run as the tick does, at SCHED_FIFO 80 and with processors out of deep sleep: other work on that "
           "processor waits");
  add.flag("--scale", &options.scale, "instead print the largest synthetic model whose field fits 1 kHz");
  add.add("--rate", &options.rate_hz, "ticks a second of cadence and growth").range(100.0, 10000.0, "Hz");
  add.add("--modes", &options.modes, "modes of these models").range(20, 1000);
  add.example("palpate-bench liver.h5 --benchmark_filter=step");
  const double seconds = leastSeconds(argc, argv);
  benchmark::Initialize(&argc, argv);  // takes its own options out
  if (!line.read(argc, argv)) return program::kDone;
  return run(options, seconds);
}

}  // namespace
}  // namespace palpate::bench

int main(int argc, char** argv) {
  return palpate::program::runProgram("palpate-bench", &palpate::bench::body, argc, argv);
}
