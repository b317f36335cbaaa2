// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace palpate::testing {

/// What a finished program left behind.
struct ProgramResult {
  int exit_code{-1};  ///< 128 + n when signal n ended it
  std::string out;
  std::string err;
};

/// Runs a program of this build to its end, without a shell.
/// @param[in] program  e.g. "palpate-tool"; a path when it has a slash
/// @throw std::runtime_error  it cannot be started
ProgramResult runProgram(const std::string& program, const std::vector<std::string>& arguments);

/// Whether the shell finds a program, e.g. "gnuplot".
[[nodiscard]] bool isInstalled(const std::string& program);

/// Expects that a program refused with one line on standard error and nothing on standard output.
/// @param[in] part  what the line contains
void expectOneLineError(const ProgramResult& result, const std::string& part);

}  // namespace palpate::testing
