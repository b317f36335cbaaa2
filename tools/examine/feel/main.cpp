// SPDX-License-Identifier: Apache-2.0
// palpate-feel: what a hand feels of a model, computed without hardware, threads and clocks.
#include "tools/examine/feel/studies.h"
#include "tools/program/command_line.h"
#include "tools/program/run.h"
#include "tools/program/write_file.h"

namespace palpate::feel {
namespace {

void addModel(program::Options& command, Study& study) {
  command.add("model", &study.model, "model file (.h5)").required();
  command.flag("--json", &study.json, "print one JSON object on standard output");
}

int body(int argc, char** argv) {
  program::CommandLine line("palpate-feel",
                            "Computes what a hand feels of a model: closed loops, slides, a device in closed "
                            "loop, and the contrast of what lies in it.");
  Study study;
  program::Options loops = line.options().subcommand(
      "loops", "closed paths: does the organ ever return more energy than it received?");
  program::Options slides =
      line.options().subcommand("slides", "random smooth slides: does the force click?");
  program::Options coupling =
      line.options().subcommand("coupling", "a device in a hand presses: up to which coupling is it stable?");
  program::Options contrast = line.options().subcommand(
      "contrast", "presses everywhere: how much larger is the force than without what lies in the organ?");
  for (program::Options* command : {&loops, &slides, &coupling, &contrast}) addModel(*command, study);
  for (program::Options* command : {&loops, &slides, &coupling})
    command->add("--seed", &study.seed, "of the random places and paths");
  loops.add("--loops", &study.count, "number of loops of each kind").range(1, 100000);
  slides.add("--paths", &study.paths, "number of slides").range(1, 100000);
  for (program::Options* command : {&loops, &slides})
    command->add("--depth", &study.depth, "of the tip below the surface").unit("m");
  slides.add("--speed", &study.speed, "of the slides").unit("m/s");
  coupling.flag("--no-device-friction", &study.frictionless,
                "without the device's Coulomb friction, which hides small instabilities");
  coupling
      .add("--delay-from", &study.delay_from,
           "under the delays of palpate-latency --samples: the largest coupling that is stable")
      .valueName("FILE");
  coupling.add("--preset", &study.preset, "this device only; default: all")
      .oneOf({"touch", "omni", "desktop", "premium15", "premium30"});
  coupling
      .add("--settings", &study.settings,
           "with --delay-from: write a configuration of palpate-server for each device, e.g. touch.toml, "
           "into this folder")
      .valueName("FOLDER");
  contrast
      .add("without", &study.without,
           "model of the same organ without what lies in it: its case file without [[region]] tables, solved")
      .required();
  contrast.add("--depth", &study.press_depth, "of the presses, along the normal").range(1e-6, 1.0, "m");
  contrast.add("--map", &study.map,
               "write the contrast over the surface: a picture (.svg) or a VTK file (.vtu)");
  line.options().example("palpate-feel coupling liver.h5");
  loops.example("palpate-feel loops liver.h5 --loops 20");
  slides.example("palpate-feel slides liver.h5 --paths 20 --speed 0.05");
  coupling.example(
      "palpate-feel coupling liver.h5 --no-device-friction\n"
      "         palpate-feel coupling liver.h5 --delay-from delays.csv --settings couplings");
  contrast.example("palpate-feel contrast with_nodule.h5 without.h5 --map contrast.svg");
  if (!line.read(argc, argv)) return program::kDone;
  program::checkOutput("--map", study.map);
  if (!study.settings.empty() && study.delay_from.empty())
    throw program::UsageError("--settings " + study.settings + ": needs --delay-from FILE");
  if (!study.settings.empty()) program::checkOutputFolder("--settings", study.settings);
  if (loops.chosen()) return runLoops(study);
  if (slides.chosen()) return runSlides(study);
  if (contrast.chosen()) return runContrast(study);
  return runCoupling(study);
}

}  // namespace
}  // namespace palpate::feel

int main(int argc, char** argv) {
  return palpate::program::runProgram("palpate-feel", &palpate::feel::body, argc, argv);
}
