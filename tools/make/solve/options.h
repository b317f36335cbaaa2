// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "tools/program/command_line.h"
#include "tools/solver/base/parallel.h"
#include "tools/solver/build/case_file.h"

namespace palpate::solve_program {

/// The command line. What it gives of the case overrides the case file.
struct Options {
  std::filesystem::path input;
  std::filesystem::path output;       ///< empty: model.h5, or standard output for a template
  std::filesystem::path batch;        ///< folder of cases, in the place of an input; output is a folder then
  std::optional<std::string> worker;  ///< "I/N", of a batch
  bool case_template{false};
  bool fresh{false};
  std::filesystem::path scratch;
  int threads{solver::machineThreads()};  ///< of several processes, main() gives each one
  bool json{false};
  bool quiet{false};

  std::optional<std::string> method, law;
  std::optional<int> element_order;
  bool mesh_error{false};
  std::optional<int> modes, order, steps;
  std::optional<std::string> target;
  std::optional<double> size_limit;
  std::optional<double> travel;  ///< m
  std::optional<double> force_error, field_error;
  bool dry_run{false};
  std::optional<std::string> direction;  ///< "x,y,z" or "any"
  std::optional<double> load;            ///< N
};

/// Adds every option to the command line.
void describe(program::Options line, Options& options);

/// What an option says that no case makes right. @throw program::UsageError
void checkOptions(const Options& options);

/// The case of a case file, or the defaults for a bare mesh, with the command line's say.
/// @throw program::UsageError when an option does not read, or does not fit a case that holds without it; CaseError when the
///        case's own keys do not fit its method
[[nodiscard]] solver::Case readCase(const Options& options);

}  // namespace palpate::solve_program
