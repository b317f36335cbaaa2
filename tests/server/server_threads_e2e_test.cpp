// SPDX-License-Identifier: Apache-2.0
// palpate-server's threads: their priorities, and the phase of its tick.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>

#include "server_fixture.h"

namespace palpate::server::testing {
namespace {

// Real-time priority of each thread by name, from /proc; 0: none.
std::map<std::string, int> priorities(pid_t pid) {
  std::map<std::string, int> found;
  for (const auto& task : std::filesystem::directory_iterator("/proc/" + std::to_string(pid) + "/task")) {
    std::string name;
    std::string stat;
    std::getline(std::ifstream(task.path() / "comm"), name);
    std::getline(std::ifstream(task.path() / "stat"), stat);
    std::istringstream fields(stat.substr(std::min(stat.size(), stat.rfind(')') + 1)));
    std::string field;
    for (int number = 3; number <= 40; ++number) fields >> field;  // proc(5): 40 is rt_priority
    if (fields) found[name] = std::stoi(field);
  }
  return found;
}

TEST_F(ServerEndToEnd, RunsItsThreadsAtTheirPriorities) {
  ASSERT_NO_FATAL_FAILURE(start());
  const auto status = client_->waitForStatus([](const auto& s) { return s.ticks > 0; });
  ASSERT_TRUE(status.has_value());
  if (!status->realtime) GTEST_SKIP() << "SCHED_FIFO is not granted here";
  const auto found = priorities(server_->pid());
  const std::map<std::string, int> wanted{
      {"tick", 80}, {"force-out", 75}, {"surface-out", 40}, {"events", 0}, {"late-watch", 0}};
  for (const auto& [name, priority] : wanted) {
    ASSERT_EQ(found.count(name), 1U) << name;
    EXPECT_EQ(found.at(name), priority) << name;
  }
  const auto receiving = std::count_if(found.begin(), found.end(), [](const auto& thread) {
    return thread.first.rfind("recv", 0) == 0 && thread.second == 70;
  });
  EXPECT_GT(receiving, 0) << "no receive thread of DDS was raised";
}

TEST_F(ServerEndToEnd, TellsWhatReceivingAndSendingTookAndWhatIsNow) {
  ASSERT_NO_FATAL_FAILURE(start());
  client_->startSending(atDepth(-0.002));
  const auto status = client_->waitForStatus([](const dds::ServerStatus& s) {
    return s.receive_recent_us.second.count > 0 && s.force_out_recent_us.second.count > 0 &&
           s.tick_recent_us.second.count > 0;
  });
  ASSERT_TRUE(status.has_value()) << server_->log();
  EXPECT_GT(status->receive_us.p50, 0.0);
  EXPECT_GE(status->receive_us.max, status->receive_recent_us.second.max);
  EXPECT_GE(status->force_out_us.max, status->force_out_recent_us.minute.max);
  EXPECT_GE(status->force_out_recent_us.minute.count, status->force_out_recent_us.second.count);
  EXPECT_GE(status->wakeup_us.count, status->wakeup_recent_us.minute.count);
  EXPECT_LT(status->tick_recent_us.second.count, 2000U) << "a second has about a thousand ticks";
}

// At 100 Hz: poses count as even when they come within a tenth of a period, which a busy machine keeps to 1 ms.
TEST_F(ServerEndToEnd, WithPhaseLockTheTicksFollowTheClient) {
  start({"--phase-lock", "--rate", "100", "--surface-rate", "50"});
  client_->startSending(atDepth(-0.002));
  const auto locked = client_->waitForStatus(
      [](const dds::ServerStatus& status) { return status.phase_lock == dds::phase::kLocked; });
  ASSERT_TRUE(locked.has_value()) << server_->log();
  client_->stopSending();
  const auto free = client_->waitForStatus(
      [](const dds::ServerStatus& status) { return status.phase_lock == dds::phase::kFree; });
  EXPECT_TRUE(free.has_value()) << server_->log();
}

}  // namespace
}  // namespace palpate::server::testing
