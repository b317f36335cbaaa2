// SPDX-License-Identifier: Apache-2.0
#include "load_bench.h"

#include <benchmark/benchmark.h>

#include "palpate/core/meta_model.h"
#include "samples.h"

namespace palpate::bench {

void registerLoad(const std::filesystem::path& model) {
  benchmark::RegisterBenchmark("load/default", [model](benchmark::State& state) {
    Samples samples;
    std::size_t bytes = 0;
    for (auto _ : state) samples.time([&] { bytes = MetaModel::load(model).bytes(); });
    samples.report(state);
    state.counters["bytes"] = static_cast<double>(bytes);
  })->Unit(benchmark::kMillisecond);
}

}  // namespace palpate::bench
