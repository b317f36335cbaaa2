// SPDX-License-Identifier: Apache-2.0
#include "tools/program/run.h"

#include <gtest/gtest.h>

#include <csignal>

namespace palpate::program::testing {

/// A parent that ignores SIGCHLD leaves that to its programs, and they would not hear how a process of theirs ended.
TEST(RunProgram, HearsHowItsProcessesEnd) {
  const auto before = std::signal(SIGCHLD, SIG_IGN);
  const auto heard = [](int, char**) { return std::signal(SIGCHLD, SIG_DFL) == SIG_DFL ? 0 : 5; };
  EXPECT_EQ(runProgram("program", heard, 0, nullptr), 0);
  std::signal(SIGCHLD, before);
}

}  // namespace palpate::program::testing
