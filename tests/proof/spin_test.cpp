// SPDX-License-Identifier: Apache-2.0
// A tick that never sleeps again: the server ends before it takes the machine (docs/design.md, Threads).
#include <gtest/gtest.h>

#include <cstdlib>
#include <string>

#include "palpate/testing/server_process.h"
#include "palpate/testing/synthetic_model.h"
#include "palpate/testing/test_domain.h"
#include "tick_counts.h"

namespace palpate::proof {
namespace {

using palpate::testing::ServerProcess;

TEST(SpinningServer, EndsWithAWordThatNamesTheThread) {
  const palpate::testing::TemporaryFile model("spin.h5");
  palpate::testing::writeSyntheticModel(model.path());
  setenv("LD_PRELOAD", (std::string(PALPATE_PROOF_DIR) + "/libpalpate_wrong_tick.so").c_str(), 1);
  setenv(kMistakeVariable, "spin", 1);
  ServerProcess server(
      {"--model", model.path().string(), "--domain", std::to_string(palpate::testing::exclusiveDomain())});
  unsetenv("LD_PRELOAD");
  unsetenv(kMistakeVariable);
  const int code = server.waitForExit(std::chrono::seconds(20));
  const std::string log = server.log();
  if (log.find("real time: SCHED_FIFO") == std::string::npos)
    GTEST_SKIP() << "SCHED_FIFO is not granted here";
  EXPECT_EQ(code, 1) << log;
  EXPECT_NE(
      log.find("thread tick computes at real-time priority 80 without a sleep for 500 ms: the server ends"),
      std::string::npos)
      << log;
}

}  // namespace
}  // namespace palpate::proof
