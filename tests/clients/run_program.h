// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace palpate::testing {

/// What a finished program left behind.
struct ProgramResult {
  int exit_code{-1};  ///< -signal when a signal ended it
  std::string out;
  std::string err;
};

/// Runs a program of this build to its end, without a shell.
/// @param[in] program    e.g. "palpate-tool"
ProgramResult runProgram(const std::string& program, const std::vector<std::string>& arguments);

}  // namespace palpate::testing
