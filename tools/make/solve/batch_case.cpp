// SPDX-License-Identifier: Apache-2.0
#include "tools/make/solve/batch_case.h"

#include <cmath>
#include <filesystem>
#include <iostream>
#include <new>
#include <optional>
#include <stdexcept>
#include <vector>

#include "tools/make/solve/checkpoint_of.h"
#include "tools/make/solve/model_there.h"
#include "tools/make/solve/own_process.h"
#include "tools/make/solve/provenance.h"
#include "tools/make/solve/solve_case.h"
#include "tools/modelfile/write_xdmf.h"
#include "tools/solver/base/file_lock.h"

namespace palpate::solve_program {

namespace {

namespace fs = std::filesystem;
using program::Json;

// What the case's process says came out: one key, whose value says more.
constexpr const char *kFound = "found", *kThere = "there", *kElsewhere = "elsewhere", *kError = "error";

/// Time of a solve, about: it goes with so many powers of the nodes, and those with the bytes of the mesh.  docs/decisions/batches.md
double workOf(const fs::path& mesh) {
  return std::pow(static_cast<double>(fs::file_size(mesh)), 1.5);
}

fs::path pictureOf(const fs::path& model) {
  return fs::path(model).replace_extension(".xdmf");
}

/// Whether what is in scratch under the model's name is the case's. In a scratch folder of its own it may be that of a case of another
/// folder, with the same name.
bool hasScratchBesideModel(const Options& options) {
  std::error_code ignored;
  return fs::equivalent(options.scratch, options.output.parent_path(), ignored);
}

bool leftParts(const Options& options) {
  return hasScratchBesideModel(options) && fs::exists(partialFolder(options));
}

/// Whether nothing is left to do beside a model: a run may have been killed just after it had written that.
bool isWhole(const Options& options) {
  return fs::exists(pictureOf(options.output)) && !leftParts(options);
}

void makeWhole(Options options, const solver::Case& c, const std::vector<std::string>& lines) {
  if (!fs::exists(pictureOf(options.output))) modelfile::writeXdmf(options.output);
  if (!leftParts(options)) return;
  options.quiet = true;
  try {
    if (const auto checkpoint = checkpointOf(options, c, lines, solver::Ranks::one())) checkpoint->remove();
  } catch (const solver::CheckpointInUse&) {
    throw;
  } catch (const solver::CheckpointError& error) {
    std::cerr << "warning: " << error.what() << '\n';  // of another case: not for us to remove
  }
}

/// One program at a time has a case, wherever its scratch is. The file stays where the program is killed, and says nothing then.
class Claim {
 public:
  /// @throw std::runtime_error  the folder of the output is gone, or no file can be made in it
  explicit Claim(const fs::path& output)
      : file_(output.string() + ".lock"), lock_(solver::FileLock::take(file_)) {
    if (!lock_ && !fs::is_directory(output.parent_path()))
      throw std::runtime_error(output.parent_path().string() + ": the folder of the models is gone");
  }
  Claim(const Claim&) = delete;
  Claim& operator=(const Claim&) = delete;
  ~Claim() {
    std::error_code ignored;  // one that is not empty is somebody's
    if (lock_ && fs::file_size(file_, ignored) == 0) fs::remove(file_, ignored);
  }
  [[nodiscard]] bool holds() const noexcept { return lock_.has_value(); }

 private:
  fs::path file_;
  std::optional<solver::FileLock> lock_;
};

/// What a solve would take. A folder that is not there yet will lie on the disk of the one around it.
Json estimate(Options options) {
  fs::path folder = fs::absolute(options.output).parent_path();
  while (!fs::exists(folder)) folder = folder.parent_path();
  options.output = folder / options.output.filename();
  if (!fs::exists(options.scratch)) options.scratch = folder;
  return solveCase(options, solver::Ranks::one());
}

/// What the case's process does. It looks again: another worker may just have ended with it.
Json solveOrLeave(const BatchCase& one) {
  Options options = one.options;
  if (options.dry_run) return {{kFound, estimate(options)}};
  const Claim claim(options.output);
  if (!claim.holds()) return {{kElsewhere, true}};
  const solver::Case c = readCase(options);
  const std::vector<std::string> lines = linesOf(c, fileHash(c.mesh));
  options.fresh = options.fresh && keepsItsWork(c);
  if (reasonToSolve(options.output, lines)) return {{kFound, solveCase(options, solver::Ranks::one())}};
  makeWhole(options, c, lines);
  return {{kThere, true}};
}

/// Of the exception that is being handled.
std::string errorText() {
  try {
    throw;
  } catch (const std::bad_alloc&) {
    return "out of memory";
  } catch (const std::exception& error) {
    return error.what();
  }
}

Json said(const BatchCase& one) {
  try {
    return solveOrLeave(one);
  } catch (const solver::CheckpointInUse& error) {
    if (hasScratchBesideModel(one.options)) return {{kElsewhere, true}};
    return {{kError, error.what()}};
  } catch (const std::exception&) {
    return {{kError, errorText()}};
  }
}

void fail(BatchCase& one, const std::string& error) {
  one.state = CaseState::kFailed;
  one.error = error;
}

}  // namespace

void look(BatchCase& one) {
  try {
    const Options& options = one.options;
    const solver::Case c = readCase(options);
    const std::vector<std::string> lines = linesOf(c, fileHash(c.mesh));
    one.work = workOf(c.mesh);
    const std::optional<std::string> reason = reasonToSolve(options.output, lines);
    if (!reason && isWhole(options)) one.state = CaseState::kThere;
    one.again = reason.value_or("");
  } catch (const std::exception&) {
    fail(one, errorText());
  }
}

void solve(BatchCase& one) {
  try {
    const Json outcome = inOwnProcess([&] { return said(one); });
    if (const Json* const error = outcome.find(kError)) return fail(one, error->text());
    if (outcome.contains(kElsewhere)) one.state = CaseState::kElsewhere;
    if (outcome.contains(kThere)) one.state = CaseState::kThere;
    const Json* const found = outcome.find(kFound);
    if (found == nullptr) return;
    one.found = *found;
    one.state = one.options.dry_run ? CaseState::kEstimated : CaseState::kSolved;
    if (const Json* const refused = found->find("refused")) fail(one, refused->text());
  } catch (const std::runtime_error& error) {
    fail(one, error.what());
  }
}

}  // namespace palpate::solve_program
