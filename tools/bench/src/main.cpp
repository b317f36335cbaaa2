// SPDX-License-Identifier: Apache-2.0
// palpate-bench: how long the parts of a tick take.
#include <benchmark/benchmark.h>

#include <CLI/CLI.hpp>
#include <exception>
#include <iostream>

#include "contact_force.h"

int main(int argc, char** argv) {
  CLI::App app(
      "Measures the parts of a tick. Options that begin with --benchmark_ are Google Benchmark's own, e.g. "
      "--benchmark_format=json, --benchmark_filter=contact_force.");
  std::string path;
  app.add_option("model", path, "model file (.h5)")->required();
  app.set_version_flag("--version", PALPATE_VERSION);
  benchmark::Initialize(&argc, argv);  // takes its own options out
  CLI11_PARSE(app, argc, argv);
  try {
    const palpate::MetaModel model = palpate::MetaModel::load(path);
    palpate::bench::registerContactForce(model);
    benchmark::RunSpecifiedBenchmarks();
  } catch (const std::exception& error) {
    std::cerr << "palpate-bench: " << error.what() << '\n';
    return 1;
  }
  return 0;
}
