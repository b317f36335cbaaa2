// SPDX-License-Identifier: Apache-2.0
// A real-time thread that never sleeps again, or never wakes: of a tick the server ends before it takes the machine, of others it goes on
// (docs/design.md, Threads; docs/decisions/spinning.md).
#include <gtest/gtest.h>

#include <csignal>
#include <cstdlib>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "core/record/record_reader.h"
#include "palpate/testing/server_process.h"
#include "palpate/testing/synthetic_model.h"
#include "palpate/testing/test_domain.h"
#include "tick_counts.h"

namespace palpate::proof {
namespace {

using palpate::testing::ServerProcess;

class SpinningServer : public ::testing::Test {
 protected:
  // One that makes the mistake.
  void start(const char* mistake, const std::vector<std::string>& more = {}) {
    palpate::testing::writeSyntheticModel(model_.path());
    setenv("LD_PRELOAD", (std::string(PALPATE_PROOF_DIR) + "/libpalpate_wrong_tick.so").c_str(), 1);
    setenv(kMistakeVariable, mistake, 1);
    std::vector<std::string> arguments{"--model", model_.path().string(), "--domain",
                                       std::to_string(palpate::testing::exclusiveDomain())};
    arguments.insert(arguments.end(), more.begin(), more.end());
    server_ = std::make_unique<ServerProcess>(arguments);
    unsetenv("LD_PRELOAD");
    unsetenv(kMistakeVariable);
  }
  // Whether the server logs it within 20 s.
  [[nodiscard]] bool logs(const char* text) const {
    for (int i = 0; i < 1000; ++i, std::this_thread::sleep_for(std::chrono::milliseconds(20)))
      if (server_->log().find(text) != std::string::npos) return true;
    return false;
  }
  [[nodiscard]] bool hasRealTime() const {
    return server_->log().find("real time: SCHED_FIFO") != std::string::npos;
  }

  const palpate::testing::TemporaryFile model_{"spin.h5"};
  std::unique_ptr<ServerProcess> server_;
};

TEST_F(SpinningServer, GoesOnWithFieldsOfAnOrdinaryThread) {
  start("spin surface-out");
  ASSERT_TRUE(logs("real time: ")) << server_->log();
  if (!hasRealTime()) GTEST_SKIP() << "SCHED_FIFO is not granted here";
  EXPECT_TRUE(
      logs("thread surface-out computes at real-time priority 40 without a sleep for 500 ms: it goes on as "
           "an ordinary "
           "thread"))
      << server_->log();
  std::this_thread::sleep_for(std::chrono::seconds(1));
  EXPECT_TRUE(server_->running()) << server_->log();
  server_->signal(SIGTERM);
  EXPECT_EQ(server_->waitForExit(), 0) << server_->log();
}

TEST_F(SpinningServer, IsStoppedWhereTheThreadThatSendsFieldsHangs) {
  const palpate::testing::TemporaryFile recording("hang.palpate");
  start("hang surface-out", {"--record", recording.path().string()});
  ASSERT_TRUE(logs("serving on DDS domain")) << server_->log();
  server_->signal(SIGTERM);
  EXPECT_EQ(server_->waitForExit(std::chrono::seconds(20)), 1) << server_->log();
  for (const char* const said : {"page faults in ticks: ", "recorded ",
                                 "thread surface-out hangs: the server ends without it after 1 s"})
    EXPECT_NE(server_->log().find(said), std::string::npos) << said << "\n" << server_->log();
  record::RecordReader recorded(recording.path());
  for (record::RecordedTick tick; recorded.next(tick);) continue;  // throws where the end is missing
  EXPECT_GT(recorded.ticks(), 0U);
}

TEST_F(SpinningServer, EndsWithAWordThatNamesTheThread) {
  start("spin");
  const int code = server_->waitForExit(std::chrono::seconds(20));
  const std::string log = server_->log();
  if (!hasRealTime()) GTEST_SKIP() << "SCHED_FIFO is not granted here";
  EXPECT_EQ(code, 1) << log;
  EXPECT_NE(
      log.find("thread tick computes at real-time priority 80 without a sleep for 500 ms: the server ends"),
      std::string::npos)
      << log;
}

}  // namespace
}  // namespace palpate::proof
