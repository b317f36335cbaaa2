// SPDX-License-Identifier: Apache-2.0
#include "tools/make/solve/checkpoint_of.h"

#include <iostream>
#include <string>
#include <vector>

#include "tools/make/solve/provenance.h"
#include "tools/solver/base/parallel.h"
#include "tools/solver/build/case_lines.h"

namespace palpate::solve_program {

bool keepsItsWork(const solver::Case& c) {
  return c.method == solver::Method::kSeriesDisplacement || c.method == solver::Method::kSeriesForce;
}

std::unique_ptr<solver::Checkpoint> checkpointOf(const Options& options, const solver::Case& c) {
  if (!keepsItsWork(c)) return nullptr;
  std::vector<std::string> solve = solver::linesOf(c);
  solve.push_back("mesh = SHA-256 " + fileHash(c.mesh));
  solve.push_back("program = SHA-256 " + fileHash("/proc/self/exe"));
  solve.push_back("BLAS = " + solver::blasVersion());
  const std::filesystem::path folder = options.scratch / (options.output.filename().string() + ".partial");
  auto checkpoint = std::make_unique<solver::Checkpoint>(folder, solve, options.fresh);
  if (checkpoint->goesOn() && !options.quiet)
    std::cerr << "goes on where an earlier run ended: " << folder.string() << '\n';
  return checkpoint;
}

}  // namespace palpate::solve_program
