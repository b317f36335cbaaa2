// SPDX-License-Identifier: Apache-2.0
// What palpate-server tells the service manager that started it, which is played here (docs/decisions/service_watchdog.md).
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <csignal>
#include <cstdlib>
#include <memory>
#include <span>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "palpate/idl/reader.h"
#include "palpate/idl/writer.h"
#include "palpate/testing/server_process.h"
#include "palpate/testing/synthetic_model.h"
#include "palpate/testing/test_domain.h"
#include "service_manager.h"
#include "stuck_thread.h"

namespace palpate::faults {
namespace {

using palpate::testing::ServerProcess;
using std::chrono::milliseconds;

constexpr milliseconds kPatience{1000};
constexpr milliseconds kLong{30'000};
constexpr char kSign[] = "WATCHDOG=1";

// Poses of a tool that is far away, so that something comes in, and goes out.
class Tool {
 public:
  explicit Tool(std::uint32_t domain) : participant_(domain), forces_(participant_), poses_(participant_) {
    sender_ = std::thread([this] {
      dds::ToolPose pose{};
      pose.position[2] = 1.0;
      pose.orientation[3] = 1.0;
      for (; !stopping_; std::this_thread::sleep_for(milliseconds(5))) {
        ++pose.seq;
        (void)poses_.write(pose);
      }
    });
  }
  // Whether a force came within 10 s.
  [[nodiscard]] bool isAnswered() const {
    for (int i = 0; i < 500; ++i, std::this_thread::sleep_for(milliseconds(20)))
      if (dds::ToolForce force; forces_.take(std::span(&force, 1)) > 0) return true;
    return false;
  }
  ~Tool() {
    stopping_ = true;
    sender_.join();
  }
  Tool(const Tool&) = delete;
  Tool& operator=(const Tool&) = delete;

 private:
  dds::Participant participant_;
  dds::Reader<dds::ToolForce> forces_;
  dds::Writer<dds::ToolPose> poses_;
  std::atomic<bool> stopping_{false};
  std::thread sender_;
};

class Service : public ::testing::Test {
 protected:
  // A server that has said that it is ready. @param[in] stuck  for the library stuck_thread; null: without it
  void start(PlayedManager& manager, const char* stuck = nullptr) {
    palpate::testing::writeSyntheticModel(model_.path());
    if (stuck != nullptr) {
      setenv("LD_PRELOAD", PALPATE_FAULTS_DIR "/libpalpate_stuck_thread.so", 1);
      setenv(kStuckVariable, stuck, 1);
    }
    server_ = std::make_unique<ServerProcess>(
        std::vector<std::string>{"--model", model_.path().string(), "--domain", std::to_string(domain_)});
    unsetenv("LD_PRELOAD");
    unsetenv(kStuckVariable);
    PlayedManager::forget();
    ASSERT_TRUE(manager.waitFor("READY=1", kLong)) << server_->log();
  }

  // Gets a thread stuck: the signs of life end for twice as long as the manager is patient, and come again with the
  // thread. A thread that waits for a processor does not count as stuck: on a busy machine the second look counts.
  void expectNoSignWhileStuck(PlayedManager& manager, const std::string& told) {
    ASSERT_TRUE(manager.waitFor(kSign, kLong)) << server_->log();
    server_->signal(SIGUSR2);
    std::vector<std::string> lines = manager.linesOf(milliseconds(400));  // with the look before
    std::ptrdiff_t signs = 1, looks = 0;
    for (; looks < 2 && signs > 0; ++looks) {
      const std::vector<std::string> more = manager.linesOf(2 * kPatience);
      signs = std::count(more.begin(), more.end(), kSign);
      lines.insert(lines.end(), more.begin(), more.end());
    }
    EXPECT_EQ(signs, 0) << server_->log();
    const std::ptrdiff_t times = std::count(lines.begin(), lines.end(), "STATUS=" + told);
    EXPECT_GE(times, 1) << server_->log();
    EXPECT_LE(times, looks) << server_->log();
    EXPECT_NE(server_->log().find(told + ": the service manager gets no sign of life"), std::string::npos);
    server_->signal(SIGUSR1);
    EXPECT_TRUE(manager.waitFor("STATUS=serving again", kLong)) << server_->log();
    EXPECT_TRUE(manager.waitFor(kSign, kLong)) << server_->log();
  }

  const std::uint32_t domain_ = palpate::testing::exclusiveDomain();
  const palpate::testing::TemporaryFile model_{"service.h5"};
  std::unique_ptr<ServerProcess> server_;
};

TEST_F(Service, SaysWhenItIsReadyThatItLivesAndThatItStops) {
  PlayedManager manager(kPatience);
  ASSERT_NO_FATAL_FAILURE(start(manager));
  const std::vector<std::string> lines = manager.linesOf(2 * kPatience);
  EXPECT_GE(std::count(lines.begin(), lines.end(), kSign), 4) << "two in each patience";
  server_->signal(SIGTERM);
  EXPECT_TRUE(manager.waitFor("STOPPING=1", kLong)) << server_->log();
  EXPECT_EQ(server_->waitForExit(), 0) << server_->log();
}

TEST_F(Service, GivesNoSignOfLifeToWhoWatchesAnotherProcessOrNone) {
  for (const auto& [patience, pid] : {std::pair(kPatience, getpid()), std::pair(milliseconds(0), 0)}) {
    PlayedManager manager(patience, pid, true);
    ASSERT_NO_FATAL_FAILURE(start(manager));
    const std::vector<std::string> lines = manager.linesOf(kPatience);
    EXPECT_EQ(std::count(lines.begin(), lines.end(), kSign), 0);
    server_.reset();
  }
}

TEST_F(Service, GivesNoSignOfLifeWhenTicksStandStill) {
  PlayedManager manager(kPatience);
  ASSERT_NO_FATAL_FAILURE(start(manager, "tick"));
  expectNoSignWhileStuck(manager, "ticks stand still");
}

TEST_F(Service, GivesNoSignOfLifeWhenPosesAreNotTaken) {
  PlayedManager manager(kPatience);
  ASSERT_NO_FATAL_FAILURE(start(manager, "recv"));
  const Tool tool(domain_);
  EXPECT_TRUE(manager.waitFor(kSign, kLong)) << "poses that are taken";
  expectNoSignWhileStuck(manager, "what comes in over DDS is not taken");
}

TEST_F(Service, GivesNoSignOfLifeWhenForcesAreNotSent) {
  PlayedManager manager(kPatience);
  ASSERT_NO_FATAL_FAILURE(start(manager, "force-out"));
  const Tool tool(domain_);
  ASSERT_TRUE(tool.isAnswered()) << server_->log();
  expectNoSignWhileStuck(manager, "forces are not sent");
}

// Who reads the log has to know whether the device was told.
TEST_F(Service, EndsAndSaysSoWhereZeroForceCannotBeSent) {
  for (const char* const stuck : {"force-out", "tick"}) {
    PlayedManager manager(kPatience);
    ASSERT_NO_FATAL_FAILURE(start(manager, stuck));
    const Tool tool(domain_);
    ASSERT_TRUE(tool.isAnswered()) << server_->log();
    server_->signal(SIGUSR2);
    EXPECT_TRUE(manager.waitFor(
        std::string(stuck) == "tick" ? "STATUS=ticks stand still" : "STATUS=forces are not sent", kLong))
        << server_->log();
    server_->signal(SIGTERM);
    std::vector<std::string> told;
    while (std::find(told.begin(), told.end(), "STATUS=zero force could not be sent") == told.end() &&
           server_->running())
      for (std::string& line : manager.linesOf(milliseconds(100))) told.push_back(std::move(line));
    EXPECT_EQ(std::count(told.begin(), told.end(), "STATUS=zero force could not be sent"), 1)
        << server_->log();
    EXPECT_EQ(std::count(told.begin(), told.end(), "STATUS=serving again"), 0) << server_->log();
    EXPECT_EQ(server_->waitForExit(std::chrono::seconds(20)), 1) << server_->log();
    EXPECT_NE(server_->log().find("stopping: zero force could not be sent"), std::string::npos)
        << server_->log();
    EXPECT_NE(server_->log().find(std::string("thread ") + stuck + " hangs: the server ends without it"),
              std::string::npos)
        << server_->log();
    EXPECT_EQ(server_->log().find("zero force was sent"), std::string::npos) << server_->log();
  }
}

}  // namespace
}  // namespace palpate::faults
