// SPDX-License-Identifier: Apache-2.0
// palpate-solve: a mesh and a case become a model file.
//
// Sample runs:  palpate-solve liver.msh -o liver.h5
//               palpate-solve case.toml -o liver.h5 --json
//               mpirun -n 2 palpate-solve case.toml -o liver.h5
//               palpate-solve case.toml -o liver.h5 --dry-run
//               palpate-solve --batch cases -o models
//               palpate-solve liver.msh --template -o case.toml
//               palpate-solve liver.msh -o lin.h5 --method pgd-linear --load-direction any
#include <algorithm>
#include <chrono>
#include <cstddef>
#include <iostream>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>

#include "tools/make/solve/batch.h"
#include "tools/make/solve/dry_run.h"
#include "tools/make/solve/options.h"
#include "tools/make/solve/solve_case.h"
#include "tools/make/solve/start_ranks.h"
#include "tools/make/solve/summary.h"
#include "tools/mesh/read_mesh.h"
#include "tools/program/run.h"
#include "tools/program/write_file.h"
#include "tools/solver/build/case_keys.h"

namespace {

using namespace palpate;

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

/// One case.
void solve(const solve_program::Options& options, const solver::Ranks& ranks) {
  const program::Json found = solve_program::solveCase(options, ranks);
  if (!ranks.isFirst()) return;
  if (!options.dry_run)
    solve_program::print(found);
  else if (!options.json)
    solve_program::printEstimate(found);
  if (options.json) std::cout << found.dump(2) << '\n';
  if (const program::Json* const refused = found.find("refused")) throw std::runtime_error(refused->text());
}

/// What options do not go together. @throw program::UsageError
void checkTogether(const solve_program::Options& options, const solver::Ranks& ranks) {
  const bool batch = !options.batch.empty();
  const std::pair<const char*, bool> for_one[] = {
      {"--batch", batch}, {"--dry-run", options.dry_run}, {"--template", options.case_template}};
  for (const auto& [option, given] : for_one)
    if (given && ranks.size() > 1)
      throw program::UsageError(std::string(option) + " is for one process, not for " +
                                std::to_string(ranks.size()));
  if (batch && &ranks != &solver::Ranks::one())
    throw program::UsageError("--batch starts its processes itself: start it without a launcher of MPI");
  if (batch && options.case_template) throw program::UsageError("--batch does not go with --template");
  if (batch && !options.input.empty())
    throw program::UsageError("--batch does not go with the input " + options.input.string() +
                              ": the folder has the cases");
  if (options.worker && !batch) throw program::UsageError("--worker is of a --batch");
  if (options.input.empty() && !batch && !options.case_template)
    throw program::UsageError("input is required: a case file or a mesh");
}

int run(solve_program::Options options, const solver::Ranks& ranks) {
  checkTogether(options, ranks);
  options.quiet = options.quiet || !ranks.isFirst();
  if (!options.batch.empty()) return solve_program::solveBatch(options);
  if (options.case_template)
    writeTemplate(options);
  else
    solve(options, ranks);
  return program::kDone;
}

/// The first rank reads the command line before the others do: what is wrong with it, and --help, is said once.
/// @return whether there is something to solve
bool readOnce(program::CommandLine& line, int argc, char** argv, const solver::Ranks& ranks) {
  std::byte goes_on{ranks.isFirst() && line.read(argc, argv)};
  ranks.broadcast({&goes_on, 1}, 0);
  return goes_on != std::byte{0} && (ranks.isFirst() || line.read(argc, argv));
}

/// For a rank that is not the first. What is wrong with the case all find, and the first one says it and ends all; where ranks share
/// cores it may find it later than this one, which waits for twice what it took so far. What a rank found alone it says after that.
void leaveTheWordToTheFirst(std::chrono::steady_clock::time_point start) {
  using std::chrono::seconds;
  const std::chrono::steady_clock::duration taken = std::chrono::steady_clock::now() - start;
  std::this_thread::sleep_for(
      std::clamp<std::chrono::steady_clock::duration>(2 * taken, seconds(1), seconds(10)));
}

int body(int argc, char** argv) {
  const auto start = std::chrono::steady_clock::now();
  const solver::Ranks& ranks = solve_program::startRanks();
  program::CommandLine line(
      "palpate-solve",
      "Computes the meta-model of an organ: its answer to a tool at any position and in any direction.");
  solve_program::Options options;
  // Launchers bind each process to a core, or have one start for each.
  if (ranks.size() > 1) options.threads = 1;
  solve_program::describe(line.options(), options);
  try {
    return readOnce(line, argc, argv, ranks) ? run(options, ranks) : program::kDone;
  } catch (...) {
    if (!ranks.isFirst()) leaveTheWordToTheFirst(start);
    throw;
  }
}

}  // namespace

int main(int argc, char** argv) {
  const int code = program::runProgram("palpate-solve", &body, argc, argv);
  solve_program::endRanks(code);
  return code;
}
