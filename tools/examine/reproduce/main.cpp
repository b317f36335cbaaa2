// SPDX-License-Identifier: Apache-2.0
// palpate-reproduce: computes the paper's benchmarks and sets them beside the paper's figures.
//
// Sample runs:  palpate-reproduce rod -o rod
//               palpate-reproduce liver -o liver --mesh organ.msh
//               palpate-reproduce all -o reproduction
//               palpate-reproduce all --quick -o quick
#include <sys/utsname.h>

#include <csignal>
#include <ctime>
#include <fstream>
#include <iostream>
#include <thread>

#include "tools/examine/reproduce/beam_study.h"
#include "tools/examine/reproduce/liver_study.h"
#include "tools/examine/reproduce/report.h"
#include "tools/examine/reproduce/rod_study.h"
#include "tools/program/command_line.h"
#include "tools/program/run.h"
#include "tools/program/write_file.h"
#include "tools/solver/base/parallel.h"

namespace {

using namespace palpate;
using reproduce::Json;

struct Options {
  std::string what;
  std::filesystem::path output{"reproduction"};
  reproduce::RodOptions rod;
  reproduce::BeamOptions beam;
  reproduce::LiverOptions liver;
  int threads{solver::machineThreads()};
  bool quick{false}, json{false}, quiet{false};
};

/// The same studies, figures and tables on smaller cases: less than three minutes in all on two cores.
void chooseQuickCases(Options& options) {
  options.rod.elements = 20;
  options.beam.nodes = {17, 7, 7};
  options.beam.steps = 25;
  options.liver.element_size = 0.0105;
  options.liver.coarse_element_size = 0.02;
  options.liver.pairs = {20, 50, 100, 167};
  options.liver.samples = 20;
}

void describe(program::Options line, Options& options) {
  line.add("what", &options.what, "rod (4.1), beam (4.2), liver (4.3) or all")
      .required()
      .oneOf({"rod", "beam", "liver", "all"});
  line.add("-o,--output", &options.output, "folder for results.json, tables, figures and report.md");
  line.flag("--quick", &options.quick,
            "smaller cases, with every figure and table, marked in the report: 20 elements for the rod, "
            "17 x 7 x 7 nodes and 25 steps for the beam, elements of 10.5 and 20 mm, at most 167 pairs and "
            "20 points for the liver; an option below still sets its own value");
  line.add("--threads", &options.threads, "worker threads").range(1, 1024);
  line.add("--rod-elements", &options.rod.elements, "elements of the rod").range(1, 1000);
  line.add("--beam-load", &options.beam.load, "load of the beam").range(1e-3, 10.0, "N");
  line.add("--beam-steps", &options.beam.steps, "load steps of the beam").range(1, 10000);
  line.add("--beam-tolerance", &options.beam.tolerance,
           "relative residual at which a load step of the beam ends")
      .range(1e-6, 1.0);
  line.add("--beam-nodes", &options.beam.nodes, "nodes of the beam along length, width, height")
      .list(',')
      .range(2, 200);
  line.add("--mesh", &options.liver.mesh,
           "organ for the liver, in metres, with a group `fixed` (default: palpate-organ paper-liver)");
  line.add("--element-size", &options.liver.element_size, "of the paper's liver").range(0.003, 0.02, "m");
  line.add("--coarse-element-size", &options.liver.coarse_element_size,
           "of the liver-like organ for the ten terms, m; 0 leaves them out")
      .rangeOr(0.008, 0.02, {"0"});
  line.add("--samples", &options.liver.samples, "held-out points of the liver").range(2, 10000);
  line.add("--pairs", &options.liver.pairs, "numbers of pairs to tabulate").list(',').range(1, 1000);
  line.flag("--json", &options.json, "also print results.json on standard output");
  line.flag("-q,--quiet", &options.quiet, "no progress");
  line.example("palpate-reproduce all --quick -o quick");
}

std::string today() {
  const std::time_t now = std::time(nullptr);
  std::tm calendar{};
  gmtime_r(&now, &calendar);
  char text[32];
  std::strftime(text, sizeof text, "%Y-%m-%d", &calendar);
  return text;
}

/// The machine of the measured times.
std::string machine() {
  utsname system{};
  uname(&system);
  std::ifstream cpus("/proc/cpuinfo");
  std::string model = system.machine;
  for (std::string line; std::getline(cpus, line);)
    if (line.rfind("model name", 0) == 0 && line.find(": ") != std::string::npos) {
      model = line.substr(line.find(": ") + 2);
      break;
    }
  return model + ", " + std::to_string(std::thread::hardware_concurrency()) + " threads, " + system.sysname;
}

Json runOne(const std::string& name, const Options& options, const std::filesystem::path& folder,
            const Json& about) {
  reproduce::Output out(folder, options.quiet);
  if (!options.quiet) std::cerr << "== " << name << '\n';
  Json results = name == "rod"    ? reproduce::reproduceRod(options.rod, out)
                 : name == "beam" ? reproduce::reproduceBeam(options.beam, out)
                                  : reproduce::reproduceLiver(options.liver, out);
  results["run"] = about;
  out.writeJson("results.json", results);
  return results;
}

void run(Options options) {
  options.rod.workers = options.beam.workers = options.liver.workers = options.threads;
  const bool all = options.what == "all";
  const reproduce::Output out(options.output, options.quiet);
  Json results{
      {"run",
       {{"version", PALPATE_VERSION}, {"date", today()}, {"machine", machine()}, {"quick", options.quick}}}};
  // 1. The benchmarks.
  for (const char* name : {"rod", "beam", "liver"}) {
    if (!all && options.what != name) continue;
    results[name] = runOne(name, options, all ? options.output / name : options.output, results["run"]);
    // 2. The report after each benchmark, so that an interrupted run leaves one too.
    if (all) out.writeJson("results.json", results);
    out.writeText("report.md", reproduce::report(results, all));
  }
  // 3. The path of the report.
  std::cerr << "report: " << out.file("report.md").string() << '\n';
  if (options.json)
    std::cout << (all ? results : results[options.what]).dump(2, program::Keys::kAsWritten) << '\n';
}

int body(int argc, char** argv) {
  std::signal(SIGPIPE, SIG_IGN);  // gnuplot may be absent: then its pipe is closed
  program::CommandLine line("palpate-reproduce",
                            "Reproduces the benchmarks of Niroomandi et al. 2013: rod, beam, liver.");
  Options options;
  describe(line.options(), options);
  if (!line.read(argc, argv)) return program::kDone;
  if (options.quick) {
    // The smaller cases replace the defaults; options on the command line replace them in turn.
    chooseQuickCases(options);
    if (!line.read(argc, argv)) return program::kDone;
  }
  program::checkOutputFolder("--output", options.output);
  run(options);
  return program::kDone;
}

}  // namespace

int main(int argc, char** argv) {
  return program::runProgram("palpate-reproduce", &body, argc, argv);
}
