// SPDX-License-Identifier: Apache-2.0
// palpate-feel: what a hand feels of a model, tried without hardware and without threads.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <exception>
#include <iostream>
#include <nlohmann/json.hpp>

#include "palpate/feel/loops.h"
#include "palpate/feel/slides.h"

namespace {

using namespace palpate;
using namespace palpate::feel;

double share(const std::vector<LoopResult>& loops, bool least) {
  const auto [low, high] = std::minmax_element(
      loops.begin(), loops.end(), [](const auto& a, const auto& b) { return a.share() < b.share(); });
  return least ? low->share() : high->share();
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("What a hand feels of a model: closed loops and slides through step().");
  std::string path;
  SlideOptions slide_options;
  LoopOptions loop_options;
  double friction = 0.0;
  app.require_subcommand(1);
  auto* slides_command = app.add_subcommand("slides", "random slides: does the force click?");
  auto* held = app.add_subcommand("held", "closed loops, anchor held");
  auto* sliding = app.add_subcommand("sliding", "press, slide, release");
  for (auto* command : {slides_command, held, sliding}) {
    command->add_option("model", path)->required();
    command->add_option("--friction", friction);
  }
  slides_command->add_option("--paths", slide_options.paths);
  slides_command->add_option("--seed", slide_options.seed);
  slides_command->add_option("--coupling", slide_options.coupling_stiffness);
  slides_command->add_option("--depth", slide_options.depth);
  held->add_option("--loops", loop_options.loops);
  sliding->add_option("--loops", loop_options.loops);
  CLI11_PARSE(app, argc, argv);
  try {
    const MetaModel model = MetaModel::load(path);
    if (*slides_command) {
      slide_options.friction = friction;
      const auto results = slides(model, slide_options);
      double worst = 0.0, lag = 0.0;
      int clicks = 0, releases = 0;
      for (const auto& r : results) {
        worst = std::max(worst, r.largest_ratio);
        lag = std::max(lag, r.largest_lag);
        clicks += r.largest_ratio > 1.0;
        releases += r.releases;
        if (r.largest_ratio > 1.0 || r.largest_lag > 1.0)
          std::printf(
              "%3d: force %.3f N median step %.5f largest %.5f ratio %.3f at %zu lag %.3f releases %d ticks "
              "%d\n",
              int(&r - results.data()), r.mean_force, r.median_step, r.largest_step, r.largest_ratio, r.worst,
              r.largest_lag, r.releases, r.ticks);
      }
      std::printf("worst ratio %.3f, lag %.3f, clicks %d, releases %d\n", worst, lag, clicks, releases);
    } else {
      const auto results =
          *held ? heldLoops(model, loop_options) : slidingLoops(model, loop_options, 0.002, friction);
      int releases = 0;
      for (const auto& r : results) releases += r.releases;
      std::printf("work / largest stored energy: %.5f to %.5f, releases %d\n", share(results, true),
                  share(results, false), releases);
    }
  } catch (const std::exception& error) {
    std::cerr << "palpate-feel: " << error.what() << '\n';
    return 1;
  }
  return 0;
}
