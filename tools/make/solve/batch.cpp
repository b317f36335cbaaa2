// SPDX-License-Identifier: Apache-2.0
#include "tools/make/solve/batch.h"

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <stdexcept>
#include <string>
#include <vector>

#include "tools/make/solve/batch_case.h"
#include "tools/make/solve/batch_report.h"
#include "tools/make/solve/summary.h"
#include "tools/program/write_file.h"
#include "tools/solver/build/build_model_parts.h"

namespace palpate::solve_program {

namespace {

namespace fs = std::filesystem;

/// The I-th of N programs.
struct Share {
  std::size_t worker{1}, workers{1};
};

/// @param text  "I/N"  @throw program::UsageError
Share shareOf(const std::string& text) {
  Share share;
  const char *const begin = text.data(), *const end = begin + text.size();
  const auto [slash, first] = std::from_chars(begin, end, share.worker);
  const bool parted = first == std::errc() && slash != end && *slash == '/';
  const auto [rest, second] = std::from_chars(parted ? slash + 1 : end, end, share.workers);
  if (!parted || second != std::errc() || rest != end || share.worker < 1 || share.worker > share.workers)
    throw program::UsageError("--worker " + text + " is not I/N, the I-th of N programs, I from 1 to N");
  return share;
}

/// Names of hidden files are an editor's or another system's.
bool isCase(const fs::directory_entry& entry) {
  return entry.path().extension() == ".toml" && entry.path().filename().string().front() != '.' &&
         entry.is_regular_file();
}

/// @throw std::runtime_error  there is no such folder, or no case in it
std::vector<fs::path> caseFiles(const fs::path& folder) {
  std::error_code error;
  std::vector<fs::path> files;
  for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error))
    if (isCase(*at)) files.push_back(at->path());
  if (error) throw std::runtime_error(folder.string() + ": cannot be read as a folder: " + error.message());
  if (files.empty())
    throw std::runtime_error(folder.string() + ": no case file (*.toml) is in it; of a mesh " +
                             "palpate-solve MESH --template -o NAME.toml makes one");
  std::sort(files.begin(), files.end());
  return files;
}

/// The cases of this worker; the folder of their models is made.
std::vector<BatchCase> casesOf(const Options& options) {
  const Share share = shareOf(options.worker.value_or("1/1"));
  const fs::path folder = options.output.empty() ? options.batch : options.output;
  checkOptions(options);
  const std::vector<fs::path> files = caseFiles(options.batch);
  if (!options.dry_run) program::checkOutputFolder("--output", folder);
  if (!options.scratch.empty()) program::checkOutput("--scratch", options.scratch / "series");
  if (!options.dry_run) fs::create_directories(folder);
  std::vector<BatchCase> cases;
  for (std::size_t i = share.worker - 1; i < files.size(); i += share.workers) {
    BatchCase one{options};
    one.options.input = files[i];
    one.options.output = (folder / files[i].filename()).replace_extension(".h5");
    if (options.scratch.empty()) one.options.scratch = folder;
    cases.push_back(one);
  }
  return cases;
}

/// How long the rest takes, as fast as the cases that were solved.
class TimeLeft {
 public:
  explicit TimeLeft(const std::vector<BatchCase>& cases) : cases_(cases) {}

  /// What failed or was left says nothing of the rest.
  void add(const BatchCase& one, double seconds) {
    if (one.state != CaseState::kSolved && one.state != CaseState::kEstimated) return;
    work_ += one.work;
    seconds_ += seconds;
  }
  /// "; about 12 min left", nothing where nothing is solved.
  [[nodiscard]] std::string text() const {
    double left = 0.0;
    for (const BatchCase& one : cases_)
      if (one.state == CaseState::kWaiting) left += one.work;
    return work_ > 0.0 ? "; about " + spanText(seconds_ * left / work_) + " left" : "";
  }

 private:
  const std::vector<BatchCase>& cases_;
  double work_{0.0}, seconds_{0.0};  ///< of what is solved
};

void tellBeginning(const std::vector<BatchCase>& cases, const Options& options) {
  const auto count = [&](CaseState state) {
    return std::count_if(cases.begin(), cases.end(),
                         [&](const BatchCase& one) { return one.state == state; });
  };
  std::cerr << options.batch.string() << ": " << cases.size() << " cases"
            << (options.worker ? " of worker " + *options.worker : "") << ", " << count(CaseState::kWaiting)
            << " to solve, " << count(CaseState::kThere) << " have their model, " << count(CaseState::kFailed)
            << " cannot be solved\n";
}

void tellError(const BatchCase& one) {
  if (one.state == CaseState::kFailed) std::cerr << "error: " << one.name() << ": " << one.error << '\n';
}

void solveAll(std::vector<BatchCase>& cases, const Options& options) {
  TimeLeft time(cases);
  std::size_t number = 0;
  for (const BatchCase& one : cases) number += one.state == CaseState::kWaiting ? 1 : 0;
  std::size_t next = 0;
  for (BatchCase& one : cases) {
    if (one.state != CaseState::kWaiting) continue;
    if (!options.quiet)
      std::cerr << "case " << ++next << " of " << number << ": " << one.name()
                << (one.again.empty() ? "" : ", again: " + one.again) << time.text() << '\n';
    const solver::Stopwatch watch;
    solve(one);
    time.add(one, watch.seconds());
    tellError(one);
    if (one.state == CaseState::kSolved) print(one.found);
  }
}

}  // namespace

int solveBatch(const Options& options) {
  const solver::Stopwatch whole;
  // 1. Which cases, and what has to be done. What cannot be read is told before hours are spent on the rest.
  std::vector<BatchCase> cases = casesOf(options);
  for (BatchCase& one : cases) {
    look(one);
    tellError(one);
  }
  if (!options.quiet) tellBeginning(cases, options);
  // 2. One after the other.
  solveAll(cases, options);
  // 3. What came out.
  const program::Json report = batchReport(options, cases, whole.seconds());
  std::fputs(batchTable(cases, report).c_str(), options.dry_run && !options.json ? stdout : stderr);
  if (options.json) std::cout << report.dump(2) << '\n';
  return report.at("failed").get<int>() > 0 ? program::kFailed : program::kDone;
}

}  // namespace palpate::solve_program
