// SPDX-License-Identifier: Apache-2.0
// palpate-replay: runs a recorded session through the engine again, and says whether it gives the same bits; or writes it as a
// table.
#include <iostream>

#include "tools/examine/replay/export_table.h"
#include "tools/examine/replay/replay.h"
#include "tools/program/command_line.h"
#include "tools/program/json.h"
#include "tools/program/run.h"
#include "tools/program/write_file.h"

namespace palpate::replay {
namespace {

struct Options {
  std::string file;
  std::string model;
  std::string format;
  std::string output;
  bool partial{false};
  bool json{false};
};

void addOptions(program::Options line, Options& options) {
  line.add("FILE", &options.file, "recording of palpate-server --record").required();
  line.add("--model", &options.model,
           "the model file that the session ran on; needed unless --export is there")
      .valueName("FILE");
  line.add("--export", &options.format, "write poses and forces as a table, csv or h5, into the file of -o")
      .oneOf({"csv", "h5"});
  line.add("-o,--output", &options.output, "the table's file").valueName("FILE");
  line.flag("--partial", &options.partial,
            "take what is there, although ticks or the end are missing, or of another engine");
  line.flag("--json", &options.json, "print one JSON object on standard output");
  line.example(
      "palpate-replay session.rec --model liver.h5\n"
      "         palpate-replay session.rec --export csv -o session.csv");
}

program::Json jsonOf(const Findings& findings, const record::SessionFacts& facts) {
  program::Json first;
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
          {"other_engine", findings.other_engine},
          {"engine", facts.engine.text()},
          {"differing_ticks", findings.differing},
          {"first_difference", first},
          {"largest_force_N", findings.largest_force},
          {"model_id", facts.model.id()}};
}

void print(const Findings& findings) {
  std::cout << findings.ticks << " ticks, " << findings.seconds << " s, largest force "
            << findings.largest_force << " N\n";
  if (findings.missing > 0)
    std::cout << findings.missing << " ticks are missing: compared from another state\n";
  if (findings.truncated) std::cout << "the recording has no end: compared as far as it goes\n";
  if (findings.other_engine) std::cout << "recorded with another engine: its answers may be other ones\n";
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

void check(const Options& options) {
  if (options.format.empty() != options.output.empty())
    throw program::UsageError("--export and -o belong together: --export csv -o FILE");
  if (options.model.empty() && options.format.empty())
    throw program::UsageError("--model is required: the model file that the session ran on");
  program::checkOutput("-o", options.output);
  if (!options.output.empty() && program::isSameFile(options.output, options.file))
    throw program::UsageError("-o " + options.output + ": is the recording itself");
}

// Writes the table. The report goes to standard output unless a replay's JSON follows there.
void writeTable(const Options& options, Demand demand) {
  record::RecordReader recording(options.file);
  const TableSize size = exportTable(recording, options.format, options.output, demand);
  std::ostream& out = options.json ? std::cerr : std::cout;
  out << size.rows << " rows of " << size.ticks << " ticks written to " << options.output << "\n";
  if (size.missing > 0) out << size.missing << " ticks are missing in it\n";
  if (size.truncated) out << "the recording has no end: written as far as it goes\n";
  if (options.json && options.model.empty())
    std::cout << program::Json{{"table", options.output},
                               {"rows", size.rows},
                               {"ticks", size.ticks},
                               {"missing", size.missing},
                               {"truncated", size.truncated}}
                     .dump(2)
              << '\n';
}

int body(int argc, char** argv) {
  // 1. What to replay.
  program::CommandLine line("palpate-replay",
                            "Runs a recorded session through the engine again and compares the answers bit "
                            "for bit, or writes it as a "
                            "table.",
                            std::string("palpate-replay ") + PALPATE_VERSION);
  Options options;
  addOptions(line.options(), options);
  if (!line.read(argc, argv)) return program::kDone;
  check(options);
  const Demand demand = options.partial ? Demand::kPartial : Demand::kWhole;
  // 2. The table, if one is wanted.
  if (!options.format.empty()) writeTable(options, demand);
  if (options.model.empty()) return program::kDone;
  // 3. The recording and its model.
  record::RecordReader recording(options.file);
  const MetaModel model = MetaModel::load(options.model);
  // 4. All its ticks.
  const Findings findings = replay(recording, model, demand);
  // 5. Tell.
  if (options.json) {
    std::cout << jsonOf(findings, recording.facts()).dump(2) << '\n';
  } else {
    print(findings);
  }
  return findings.differing == 0 ? program::kDone : program::kNotHeld;
}

}  // namespace
}  // namespace palpate::replay

int main(int argc, char** argv) {
  return palpate::program::runProgram("palpate-replay", &palpate::replay::body, argc, argv);
}
