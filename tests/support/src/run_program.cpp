// SPDX-License-Identifier: Apache-2.0
#include "palpate/testing/run_program.h"

#include <gtest/gtest.h>

#include <cstdlib>

#include "palpate/testing/child_process.h"

namespace palpate::testing {

ProgramResult runProgram(const std::string& program, const std::vector<std::string>& arguments) {
  const CaughtOutput out, err;
  ChildProcess process(program, arguments, {out.descriptor(), err.descriptor()});
  const int exit_code = process.waitForExit();
  return {exit_code, out.text(), err.text()};
}

bool isInstalled(const std::string& program) {
  return std::system(("command -v " + program + " >/dev/null").c_str()) == 0;
}

void expectOneLineError(const ProgramResult& result, const std::string& part) {
  EXPECT_GT(result.exit_code, 0) << result.err;
  EXPECT_LT(result.exit_code, 128) << "a signal ended it";
  EXPECT_TRUE(result.out.empty()) << result.out;
  EXPECT_EQ(result.err.find('\n'), result.err.size() - 1) << result.err;
  EXPECT_NE(result.err.find(part), std::string::npos) << result.err;
}

}  // namespace palpate::testing
