// SPDX-License-Identifier: Apache-2.0
#include "tools/examine/bench/field.h"

#include <benchmark/benchmark.h>

#include <memory>
#include <string>

#include "tools/examine/bench/field_race.h"

namespace palpate::bench {

namespace {

struct Size {
  int nodes, modes;
  friend bool operator==(const Size&, const Size&) = default;
};

constexpr Size kSizes[] = {{500, 20},    {500, 100},  {500, 300},   {2009, 40},   {2009, 100},
                           {2009, 167},  {2009, 300}, {5000, 100},  {10000, 100}, {20000, 20},
                           {20000, 100}, {50000, 20}, {50000, 100}, {50000, 300}};
constexpr int kPositions = 300;  // a path of 5 mm meets few of them

const char* nameOf(Runner who) {
  constexpr std::array<const char*, kRunners.size()> kNames{"palpate", "eigen_f32", "plain_read"};
  return kNames[static_cast<std::size_t>(who)];
}

/// The race of one size, run at its first use. Only the last race is kept: large models fill the memory.
FieldRace& raceOf(const Size& size, double seconds) {
  static Size held{};
  static std::unique_ptr<FieldRace> race;
  if (race == nullptr || !(held == size)) {
    race.reset();
    race = std::make_unique<FieldRace>(SyntheticSize{size.nodes, size.modes, kPositions});
    race->measure(3.0 * seconds);
    held = size;
  }
  return *race;
}

void field(benchmark::State& state, const Size& size, Runner who, double seconds) {
  FieldRace& race = raceOf(size, seconds);
  for (auto _ : state) race.run(who);
  race.samples(who).report(state);
  state.counters["bytes"] = static_cast<double>(race.bytes(who));
  state.counters["error_max"] = race.errorMax(who);
}

}  // namespace

void registerFields(double seconds) {
  for (const Size& size : kSizes)
    for (const Runner who : kRunners) {
      const std::string name =
          "field/" + std::to_string(size.nodes) + "x" + std::to_string(size.modes) + "/" + nameOf(who);
      benchmark::RegisterBenchmark(name.c_str(), [size, who, seconds](benchmark::State& state) {
        field(state, size, who, seconds);
      })->Unit(benchmark::kMicrosecond);
    }
}

}  // namespace palpate::bench
