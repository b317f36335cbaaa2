// SPDX-License-Identifier: Apache-2.0
#include "tools/make/solve/checkpoint_of.h"

#include <cstdint>
#include <filesystem>
#include <iostream>
#include <span>
#include <string>
#include <vector>

#include "tools/make/solve/provenance.h"
#include "tools/solver/base/parallel.h"
#include "tools/solver/build/case_lines.h"

namespace palpate::solve_program {

namespace {

std::filesystem::path folderOf(const Options& options, int rank) {
  std::string name = options.output.filename().string();
  name += ".partial";
  if (rank > 0) name += '.' + std::to_string(rank);
  return options.scratch / name;
}

/// @throw solver::CheckpointError  a line differs from that of the first rank
void requireSame(const std::vector<std::string>& solve, const solver::Ranks& ranks) {
  for (const std::string& line : solve) {
    std::string first = line;
    std::uint64_t size = first.size();
    ranks.broadcast(std::as_writable_bytes(std::span(&size, 1)), 0);
    first.resize(size);
    ranks.broadcast(std::as_writable_bytes(std::span(first)), 0);
    if (line != first)
      throw solver::CheckpointError("process " + std::to_string(ranks.rank()) + " has " + line +
                                    ", the first one " + first);
  }
}

/// What more ranks than now have left goes.
void removeOthers(const Options& options, const std::vector<std::string>& solve, int rank) {
  for (; std::filesystem::exists(folderOf(options, rank)); ++rank)
    solver::Checkpoint(folderOf(options, rank), solve, true).remove();
}

}  // namespace

bool keepsItsWork(const solver::Case& c) {
  return c.method == solver::Method::kSeriesDisplacement || c.method == solver::Method::kSeriesForce;
}

std::unique_ptr<solver::Checkpoint> checkpointOf(const Options& options, const solver::Case& c,
                                                 const solver::Ranks& ranks) {
  if (!keepsItsWork(c)) return nullptr;
  std::vector<std::string> solve = solver::linesOf(c);
  solve.push_back("mesh = SHA-256 " + fileHash(c.mesh));
  solve.push_back("program = SHA-256 " + fileHash("/proc/self/exe"));
  solve.push_back("BLAS = " + solver::blasVersion());
  solve.push_back("processes = " + std::to_string(ranks.size()));
  requireSame(solve, ranks);
  const std::filesystem::path folder = folderOf(options, ranks.rank());
  auto checkpoint = std::make_unique<solver::Checkpoint>(folder, solve, options.fresh);
  if (options.fresh && ranks.isFirst()) removeOthers(options, solve, ranks.size());
  if (checkpoint->goesOn() && !options.quiet)
    std::cerr << "goes on where an earlier run ended: " << folder.string() << '\n';
  return checkpoint;
}

}  // namespace palpate::solve_program
