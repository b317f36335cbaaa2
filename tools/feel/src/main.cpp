// SPDX-License-Identifier: Apache-2.0
// palpate-feel: what a hand feels of a model, tried without hardware, threads and clocks.
#include <CLI/CLI.hpp>
#include <exception>
#include <iostream>

#include "studies.h"

namespace {

using palpate::feel::Study;

void addModel(CLI::App& command, Study& study) {
  command.add_option("model", study.model, "model file (.h5)")->required();
  command.add_option("--seed", study.seed, "of the random places and ways")->capture_default_str();
  command.add_flag("--json", study.json, "print one JSON object on standard output");
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app(
      "Tries what a hand feels of a model: closed loops, slides and a device in closed loop, through "
      "step().");
  app.set_version_flag("--version", PALPATE_VERSION);
  app.require_subcommand(1);
  Study study;
  auto* loops =
      app.add_subcommand("loops", "closed ways: does the organ ever give back more energy than it got?");
  auto* slides = app.add_subcommand("slides", "random smooth slides: does the force click?");
  auto* coupling =
      app.add_subcommand("coupling", "a held device presses: up to which coupling is it stable?");
  for (CLI::App* command : {loops, slides, coupling}) addModel(*command, study);
  loops->add_option("--loops", study.count, "how many of each kind")->check(CLI::Range(1, 100000));
  slides->add_option("--paths", study.paths, "how many")->capture_default_str()->check(CLI::Range(1, 100000));
  for (CLI::App* command : {loops, slides})
    command->add_option("--depth", study.depth, "of the tip below the surface, m")->capture_default_str();
  slides->add_option("--speed", study.speed, "m/s")->capture_default_str();
  coupling->add_flag("--no-device-friction", study.frictionless,
                     "without the device's Coulomb friction, which hides small instabilities");
  CLI11_PARSE(app, argc, argv);
  try {
    if (*loops) return palpate::feel::runLoops(study);
    if (*slides) return palpate::feel::runSlides(study);
    return palpate::feel::runCoupling(study);
  } catch (const std::exception& error) {
    std::cerr << "palpate-feel: " << error.what() << '\n';
    return 1;
  }
}
