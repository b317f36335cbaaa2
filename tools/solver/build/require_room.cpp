// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <string>
#include <system_error>

#include "core/base/multi_index.h"
#include "core/data/available_memory.h"
#include "tools/solver/build/case_error.h"
#include "tools/solver/build/estimate.h"

namespace palpate::solver {

namespace {

constexpr double kOverestimate = 1.3;  // an estimate at most, over what it estimates

std::string gigabytes(double bytes) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2f GB", 1e-9 * bytes);
  return text;
}

/// Free bytes of a folder's disk; without bound where the system does not say.
double freeIn(const std::filesystem::path& folder) {
  std::error_code error;
  const std::filesystem::space_info space = std::filesystem::space(folder, error);
  return error ? 1e300 : static_cast<double>(space.available);
}

/// The degree makes most of a table's columns: what one degree less leaves.
std::string lowerOrder(const Case& c, double bytes) {
  const int p = c.orders().fields;
  if (p < 2) return "larger elements";
  const double share = static_cast<double>(MonomialBasis::size(p - 1)) / MonomialBasis::size(p);
  return "--order " + std::to_string(p - 1) + " (about " + gigabytes(share * bytes) + ") or larger elements";
}

}  // namespace

void requireRoom(const Estimate& estimate, const Case& c, const BuildOptions& options,
                 const std::filesystem::path& output) {
  const double kept = options.checkpoint == nullptr ? 0.0 : options.checkpoint->bytes();
  if (const double room = freeIn(options.scratch) + kept; estimate.scratch > room)
    throw CaseError(options.scratch.string() + ": needs " + gigabytes(estimate.scratch) + " of scratch, " +
                    gigabytes(room) + " are free: --scratch takes a folder of another disk, or " +
                    lowerOrder(c, estimate.scratch) + " need less");
  if (const double room = freeIn(output); !output.empty() && estimate.file > kOverestimate * room)
    throw CaseError(output.string() + ": the model file needs about " + gigabytes(estimate.file) + ", " +
                    gigabytes(room) + " are free: --output takes a folder of another disk; " +
                    (c.handheld() ? "--size-limit" : "--target handheld") + " or " +
                    lowerOrder(c, estimate.file) + " makes it smaller");
  const AvailableMemory memory = availableMemory();
  // A limit of address space is each process's own.
  const int sharing = memory.limit == "ulimit -v" ? 1 : options.ranks->onMachine();
  const double room = estimate.resident + static_cast<double>(memory.bytes) / sharing;
  if (estimate.memory > kOverestimate * room)
    throw CaseError(c.mesh.string() + ": needs about " + gigabytes(estimate.memory) + " of memory, " +
                    gigabytes(room) + " are available (" + memory.limit +
                    (sharing > 1 ? ", shared by " + std::to_string(sharing) + " processes" : "") +
                    "): fewer " + (sharing > 1 ? "processes, " : "") + "--threads or --modes, " +
                    lowerOrder(c, estimate.memory) + " need less");
}

}  // namespace palpate::solver
