// SPDX-License-Identifier: Apache-2.0
#include "tools/make/solve/checkpoint_of.h"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <filesystem>
#include <iostream>
#include <span>
#include <string>
#include <system_error>
#include <vector>

#include "tools/make/solve/provenance.h"
#include "tools/solver/build/build_model.h"

namespace palpate::solve_program {

namespace {

std::string nameOf(const Options& options) {
  return options.output.filename().string() + ".partial";
}

std::filesystem::path folderOf(const Options& options, int rank) {
  return options.scratch / (rank > 0 ? nameOf(options) + '.' + std::to_string(rank) : nameOf(options));
}

/// What one rank says, on all.
std::string told(const solver::Ranks& ranks, std::string text, int from) {
  std::uint64_t size = text.size();
  ranks.broadcast(std::as_writable_bytes(std::span(&size, 1)), from);
  text.resize(size);
  ranks.broadcast(std::as_writable_bytes(std::span(text)), from);
  return text;
}

/// @throw solver::CheckpointError  a line differs from that of the first rank
void requireSame(const std::vector<std::string>& solve, const solver::Ranks& ranks) {
  for (const std::string& line : solve)
    if (const std::string first = told(ranks, line, 0); line != first)
      throw solver::CheckpointError("process " + std::to_string(ranks.rank()) + " has " + line +
                                    ", the first one " + first);
}

/// Folders of ranks from this one's size on, which a solve by more processes has left here. Their numbers may have gaps.
std::vector<std::filesystem::path> foldersOfMore(const Options& options, int size) {
  const std::string begin = nameOf(options) + '.';
  std::vector<std::filesystem::path> found;
  for (const auto& entry : std::filesystem::directory_iterator(options.scratch)) {
    const std::string name = entry.path().filename().string();
    if (name.rfind(begin, 0) != 0 || !entry.is_directory()) continue;
    const char* const end = name.data() + name.size();
    int rank = 0;
    const auto [rest, error] = std::from_chars(name.data() + begin.size(), end, rank);
    if (error == std::errc() && rest == end && rank >= size) found.push_back(entry.path());
  }
  std::sort(found.begin(), found.end());
  return found;
}

/// This rank's folder. The first one's is only made where no other number of ranks has left something; --fresh removes that.
std::unique_ptr<solver::Checkpoint> openedBy(const Options& options, const std::vector<std::string>& solve,
                                             const solver::Ranks& ranks) {
  auto own = std::make_unique<solver::Checkpoint>(folderOf(options, ranks.rank()), solve, options.fresh);
  if (ranks.isFirst())
    for (const std::filesystem::path& folder : foldersOfMore(options, ranks.size()))
      solver::Checkpoint(folder, solve, options.fresh).remove();
  return own;
}

}  // namespace

bool keepsItsWork(const solver::Case& c) {
  return c.method == solver::Method::kSeriesDisplacement || c.method == solver::Method::kSeriesForce;
}

std::filesystem::path partialFolder(const Options& options) {
  return folderOf(options, 0);
}

std::unique_ptr<solver::Checkpoint> checkpointOf(const Options& options, const solver::Case& c,
                                                 std::vector<std::string> solve, const solver::Ranks& ranks) {
  if (!keepsItsWork(c)) return nullptr;
  solve.push_back("program = SHA-256 " + fileHash("/proc/self/exe"));
  solve.push_back("arithmetic = " + solver::arithmetic());
  solve.push_back("processes = " + std::to_string(ranks.size()));
  requireSame(solve, ranks);
  std::unique_ptr<solver::Checkpoint> checkpoint;
  // The first one, then the others: what is refused leaves no new folder at any rank.
  for (const bool first : {true, false}) {
    std::string wrong;
    bool in_use = false;
    try {
      if (ranks.isFirst() == first) checkpoint = openedBy(options, solve, ranks);
    } catch (const solver::CheckpointInUse& error) {
      wrong = error.what();
      in_use = true;
    } catch (const solver::CheckpointError& error) {
      wrong = error.what();
    }
    if (ranks.all(wrong.empty())) continue;
    checkpoint.reset();
    std::string first_wrong;
    for (int from = 0; from < ranks.size() && first_wrong.empty(); ++from)
      first_wrong = told(ranks, wrong, from);
    // Also waits until all have removed theirs.
    if (!ranks.all(!in_use)) throw solver::CheckpointInUse(first_wrong);
    throw solver::CheckpointError(first_wrong);
  }
  if (checkpoint->goesOn() && !options.quiet)
    std::cerr << "goes on where an earlier run ended: " << checkpoint->folder().string() << '\n';
  return checkpoint;
}

}  // namespace palpate::solve_program
