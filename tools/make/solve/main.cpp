// SPDX-License-Identifier: Apache-2.0
// palpate-solve: a mesh and a case become a model file.
//
// Sample runs:  palpate-solve liver.msh -o liver.h5
//               palpate-solve case.toml -o liver.h5 --json
//               mpirun -n 2 palpate-solve case.toml -o liver.h5
//               palpate-solve case.toml -o liver.h5 --dry-run
//               palpate-solve liver.msh --template -o case.toml
//               palpate-solve liver.msh -o lin.h5 --method pgd-linear --load-direction any
#include <chrono>
#include <cstddef>
#include <iostream>
#include <memory>
#include <string>
#include <thread>

#include "tools/make/solve/checkpoint_of.h"
#include "tools/make/solve/dry_run.h"
#include "tools/make/solve/options.h"
#include "tools/make/solve/provenance.h"
#include "tools/make/solve/size_warnings.h"
#include "tools/make/solve/start_ranks.h"
#include "tools/make/solve/summary.h"
#include "tools/mesh/checks.h"
#include "tools/mesh/mesh_error.h"
#include "tools/mesh/midsides.h"
#include "tools/mesh/read_mesh.h"
#include "tools/modelfile/write_model.h"
#include "tools/modelfile/write_xdmf.h"
#include "tools/program/run.h"
#include "tools/program/write_file.h"
#include "tools/solver/build/build_model.h"
#include "tools/solver/build/case_keys.h"

namespace {

using namespace palpate;
using Clock = std::chrono::steady_clock;

double secondsSince(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// A bare mesh that names its accessible group means it.
void adoptGroups(solver::Case& c, const mesh::TetMesh& organ) {
  if (c.text.empty() && organ.groups.count("accessible") != 0) c.accessible = "accessible";
}

/// What can be said of the output before minutes are spent on it.
void checkOutput(const std::filesystem::path& output) {
  if (output.extension() == ".xdmf")
    throw program::UsageError("--output " + output.string() +
                              ": an .xdmf is written beside the model; name the model .h5");
  program::checkOutput("--output", output);
}

mesh::TetMesh readOrgan(const std::filesystem::path& path, const std::string& fixed) {
  mesh::TetMesh organ = mesh::readMesh(path);
  try {
    mesh::checkMesh(organ);
    (void)mesh::straighten(organ);  // what rounding of the file has moved
    if (organ.groups.count(fixed) != 0) mesh::checkHeld(organ, fixed);
  } catch (const mesh::MeshError& error) {
    throw mesh::MeshError(path.string() + ": " + error.what());
  }
  return organ;
}

/// What a solve takes; nothing is written.
void tell(const solve_program::Options& options, const solver::Case& c, const mesh::TetMesh& organ,
          const solver::BuildOptions& build) {
  solver::BuildReport report;
  const solver::Estimate estimate = solver::estimateDisplacementSeries(c, organ, build, report);
  const program::Json found = solve_program::estimateOf(estimate, c, report);
  if (options.json)
    std::cout << found.dump(2) << '\n';
  else
    solve_program::printEstimate(found);
  solver::Case chosen = c;
  if (report.travel) {
    chosen.order = report.travel->orders.fields;
    chosen.force_order = report.travel->orders.answer;
  }
  solver::requireRoom(estimate, chosen, build, build.output);
}

/// A case file to begin with.
/// @throw program::UsageError
void writeTemplate(const solve_program::Options& options) {
  program::checkOutput("--output", options.output);
  if (!options.output.empty() && program::isSameFile(options.output, options.input))
    throw program::UsageError("--output " + options.output.string() + " would replace the input");
  const bool given = !options.input.empty();
  const bool accessible = given && mesh::readMesh(options.input).groups.count("accessible") != 0;
  // A path in a case starts at the case.
  const std::filesystem::path at = options.output.empty()
                                       ? std::filesystem::current_path()
                                       : std::filesystem::absolute(options.output).parent_path();
  const std::string named =
      given ? std::filesystem::absolute(options.input).lexically_proximate(at).string() : "organ.msh";
  const std::string text = solver::caseTemplate(named, accessible);
  if (options.output.empty())
    std::cout << text;
  else
    program::writeFile(options.output, text);
}

/// All ranks know that the file is there.
void waitForFile(const solver::Ranks& ranks) {
  std::byte written{1};
  ranks.broadcast({&written, 1}, 0);
}

void run(solve_program::Options options, const solver::Ranks& ranks) {
  if (ranks.size() > 1 && (options.case_template || options.dry_run))
    throw program::UsageError(std::string(options.dry_run ? "--dry-run" : "--template") +
                              " is for one process, not for " + std::to_string(ranks.size()));
  options.quiet = options.quiet || !ranks.isFirst();
  if (options.case_template) return writeTemplate(options);
  if (options.input.empty()) throw program::UsageError("input is required: a case file or a mesh");
  if (options.output.empty()) options.output = "model.h5";
  const auto start = Clock::now();
  // 1. What to solve, and where to.
  checkOutput(options.output);
  solver::Case c = solve_program::readCase(options);
  if (options.dry_run && c.method != solver::Method::kSeriesDisplacement)
    throw program::UsageError("--dry-run is for method series-displacement, not " + toString(c.method));
  if (options.fresh && !solve_program::keepsItsWork(c))
    throw program::UsageError("--fresh is for the series methods, not " + toString(c.method));
  if (!options.scratch.empty()) program::checkOutput("--scratch", options.scratch / "series");
  // 2. The organ.
  const mesh::TetMesh organ = solver::raised(c, readOrgan(c.mesh, c.fixed));
  adoptGroups(c, organ);
  const std::filesystem::path folder = std::filesystem::absolute(options.output).parent_path();
  if (options.scratch.empty()) options.scratch = folder;
  solver::BuildOptions build{options.threads, options.scratch, options.quiet, folder};
  build.ranks = &ranks;
  for (const std::string& warning : solve_program::sizeWarnings(c, organ))
    if (ranks.isFirst()) std::cerr << "warning: " << warning << '\n';
  if (options.dry_run) return tell(options, c, organ, build);
  // 3. The model, by the method of the case.
  solver::BuildReport report;
  const std::unique_ptr<solver::Checkpoint> checkpoint = solve_program::checkpointOf(options, c, ranks);
  build.checkpoint = checkpoint.get();
  modelfile::ModelData data = solver::buildModel(c, organ, build, report);
  if (checkpoint) report.kept_seconds = checkpoint->found();
  // 4. Where it came from, and the file, by the first rank.
  if (!ranks.isFirst()) {
    waitForFile(ranks);
    if (checkpoint) checkpoint->remove();
    return;
  }
  solve_program::addProvenance(data, c, report);
  const auto write_start = Clock::now();
  modelfile::writeModel(options.output, data);
  modelfile::writeXdmf(options.output);
  const double write_seconds = secondsSince(write_start);
  waitForFile(ranks);
  if (checkpoint) checkpoint->remove();
  // 5. What came out.
  const program::Json s =
      solve_program::summarize(options.output, c, data, report, write_seconds, secondsSince(start));
  solve_program::print(s);
  if (options.json) std::cout << s.dump(2) << '\n';
}

/// The first rank reads the command line before the others do: what is wrong with it, and --help, is said once.
/// @return whether there is something to solve
bool readOnce(program::CommandLine& line, int argc, char** argv, const solver::Ranks& ranks) {
  std::byte goes_on{ranks.isFirst() && line.read(argc, argv)};
  ranks.broadcast({&goes_on, 1}, 0);
  return goes_on != std::byte{0} && (ranks.isFirst() || line.read(argc, argv));
}

int body(int argc, char** argv) {
  const solver::Ranks& ranks = solve_program::startRanks();
  program::CommandLine line(
      "palpate-solve",
      "Computes the meta-model of an organ: its answer to a tool at any position and in any direction.");
  solve_program::Options options;
  // Launchers bind each process to a core, or have one start for each.
  if (ranks.size() > 1) options.threads = 1;
  solve_program::describe(line.options(), options);
  try {
    if (readOnce(line, argc, argv, ranks)) run(options, ranks);
  } catch (...) {
    // What is wrong with the case all ranks find, and the first one says it and ends all.
    if (!ranks.isFirst()) std::this_thread::sleep_for(std::chrono::seconds(1));
    try {
      throw;
    } catch (const std::bad_alloc&) {
      throw std::runtime_error(
          "out of memory; fewer modes, a smaller near_radius or a lower order need less");
    }
  }
  return program::kDone;
}

}  // namespace

int main(int argc, char** argv) {
  const int code = program::runProgram("palpate-solve", &body, argc, argv);
  solve_program::endRanks(code);
  return code;
}
