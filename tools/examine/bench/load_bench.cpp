// SPDX-License-Identifier: Apache-2.0
#include "tools/examine/bench/load_bench.h"

#include <benchmark/benchmark.h>

#include "core/model/meta_model.h"
#include "tools/examine/bench/samples.h"

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
