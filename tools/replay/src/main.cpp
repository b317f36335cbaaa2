// SPDX-License-Identifier: Apache-2.0
// palpate-replay: runs a recorded session through the engine again, and says whether it gives the same bits.
#include <CLI/CLI.hpp>
#include <iostream>
#include <nlohmann/json.hpp>

#include "palpate/replay/replay.h"

namespace palpate::replay {
namespace {

struct Options {
  std::string file;
  std::string model;
  bool partial{false};
  bool json{false};
};

void addOptions(CLI::App& app, Options& options) {
  app.add_option("FILE", options.file, "recording of palpate-server --record")->required();
  app.add_option("--model", options.model, "the model file that the session ran on")
      ->required()
      ->type_name("FILE");
  app.add_flag("--partial", options.partial, "replay what is there, although ticks or the end are missing");
  app.add_flag("--json", options.json, "print one JSON object on standard output");
  app.set_version_flag("--version", std::string("palpate-replay ") + PALPATE_VERSION);
}

nlohmann::json jsonOf(const Findings& findings, const record::SessionFacts& facts) {
  nlohmann::json first;
  if (findings.first) {
    first = {{"tick", findings.first->tick},
             {"tool", findings.first->tool},
             {"field", findings.first->field},
             {"recorded", findings.first->recorded},
             {"replayed", findings.first->replayed}};
  }
  return {{"identical", findings.differing == 0},
          {"ticks", findings.ticks},
          {"seconds", findings.seconds},
          {"missing", findings.missing},
          {"truncated", findings.truncated},
          {"differing_ticks", findings.differing},
          {"first_difference", first},
          {"largest_force_N", findings.largest_force},
          {"model_id", facts.model_id}};
}

void print(const Findings& findings) {
  std::cout << findings.ticks << " ticks, " << findings.seconds << " s, largest force "
            << findings.largest_force << " N\n";
  if (findings.missing > 0)
    std::cout << findings.missing << " ticks are missing: compared from another state\n";
  if (findings.truncated) std::cout << "the recording has no end: compared as far as it goes\n";
  if (findings.differing == 0) {
    std::cout << "identical, bit for bit\n";
    return;
  }
  const Difference& first = *findings.first;
  std::cout.precision(17);
  std::cout << findings.differing << " ticks differ, first tick " << first.tick << ", tool " << first.tool
            << ", " << first.field << ": recorded " << first.recorded << ", replayed " << first.replayed
            << "\n";
}

int body(int argc, char** argv) {
  // 1. What to replay.
  CLI::App app("Runs a recorded session through the engine again and compares the answers bit for bit.",
               "palpate-replay");
  Options options;
  addOptions(app, options);
  CLI11_PARSE(app, argc, argv);
  // 2. The recording and its model.
  record::RecordReader recording(options.file);
  const MetaModel model = MetaModel::load(options.model);
  // 3. All its ticks.
  const Findings findings = replay(recording, model, options.partial ? Demand::kPartial : Demand::kWhole);
  // 4. Tell.
  if (options.json) {
    std::cout << jsonOf(findings, recording.facts()).dump(2) << '\n';
  } else {
    print(findings);
  }
  return findings.differing == 0 ? 0 : 1;
}

}  // namespace
}  // namespace palpate::replay

int main(int argc, char** argv) {
  try {
    return palpate::replay::body(argc, argv);
  } catch (const std::exception& error) {
    std::cerr << "palpate-replay: " << error.what() << '\n';
    return 1;
  }
}
