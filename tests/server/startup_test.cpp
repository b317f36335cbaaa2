// SPDX-License-Identifier: Apache-2.0
#include "palpate/server/startup.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <map>
#include <sstream>

#include "palpate/testing/files.h"
#include "palpate/testing/run_program.h"

namespace palpate::server {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

Startup allGranted() {
  Startup startup;
  startup.memory = {0, true, true};
  startup.model_locked = true;
  startup.awake = true;
  startup.threads = {{1, "palpate-server", 0, {0, 1, 2, 3}},
                     {2, "tick", 80, {2}},
                     {3, "force-out", 75, {0, 1, 3}},
                     {4, "recvUC", 70, {0, 1, 3}},
                     {5, "gc", 0, {0, 1, 3}}};
  return startup;
}

TEST(StartupTable, SaysWhatWasWantedAndWhatWasHad) {
  EXPECT_THAT(
      startupTable(allGranted()),
      ElementsAre("thread           wanted       got                            CPUs",
                  "palpate-server   other        other                          0-3",
                  "tick             FIFO 80      FIFO 80                        2",
                  "force-out        FIFO 75      FIFO 75                        0-1,3",
                  "recvUC           FIFO 70      FIFO 70                        0-1,3",
                  "gc               other        other                          0-1,3",
                  "DDS receive      raised       1 raised",
                  "memory locked    all          all, and what comes",
                  "prefaulted       all          all, and stacks", "cpu_dma_latency  0 us         0 us"));
  EXPECT_THAT(remedies(allGranted()), IsEmpty());
}

TEST(StartupTable, NamesTheWayToWhateverIsMissing) {
  Startup startup = allGranted();
  startup.threads[3].fifo_priority = 0;
  EXPECT_THAT(startupTable(startup)[6], HasSubstr("0 raised"));
  EXPECT_THAT(remedies(startup), ElementsAre(HasSubstr("rtprio 90")));
  startup = allGranted();
  startup.memory = {1, false, false};
  EXPECT_THAT(startupTable(startup)[7], HasSubstr("refused: Operation not permitted"));
  EXPECT_THAT(remedies(startup), ElementsAre(HasSubstr("memlock unlimited")));
  startup = allGranted();
  startup.awake = false;
  EXPECT_THAT(startupTable(startup)[9], HasSubstr("not held"));
  EXPECT_THAT(remedies(startup), ElementsAre(HasSubstr("/dev/cpu_dma_latency")));
}

TEST(StartupTable, WhatWasNotAskedForIsNotMissing) {
  Startup startup = allGranted();
  startup.policy = rt::RealtimePolicy::kOff;
  startup.awake = false;
  for (rt::ThreadFacts& thread : startup.threads) thread.fifo_priority = 0;
  EXPECT_THAT(startupTable(startup)[2], HasSubstr("other        other"));
  EXPECT_THAT(remedies(startup), IsEmpty());
}

TEST(LeaveCpuToTheTick, RefusesToLeaveNothing) {
  const std::vector<int> usable = rt::usableCpus();
  ASSERT_FALSE(usable.empty());
  ASSERT_EQ(rt::useCpus({usable.data(), 1}), 0);
  try {
    leaveCpuToTheTick(usable[0]);
    FAIL() << "accepted";
  } catch (const std::runtime_error& error) {
    EXPECT_EQ(std::string(error.what()),
              "tick_cpu_alone: no CPU is left for the other threads but " + std::to_string(usable[0]));
  }
  ASSERT_EQ(rt::useCpus(usable), 0);
}

// Files for users who run the server without root.
std::string textOf(const std::string& path) {
  EXPECT_TRUE(std::filesystem::exists(path)) << path;
  return testing::contentOf(path);
}

TEST(ServiceFiles, TheUnitGrantsWhatTheThreadsWant) {
  std::istringstream lines(textOf(PALPATE_SERVICE_FILE));
  std::map<std::string, std::string> values;
  std::string section;
  for (std::string line; std::getline(lines, line);) {
    if (line.empty() || line[0] == '#') continue;
    if (line[0] == '[') {
      section = line;
      continue;
    }
    const std::size_t equals = line.find('=');
    ASSERT_NE(equals, std::string::npos) << line;
    values[section + line.substr(0, equals)] = line.substr(equals + 1);
  }
  EXPECT_GE(std::stoi(values["[Service]LimitRTPRIO"]), kTickPriority);
  EXPECT_EQ(values["[Service]LimitMEMLOCK"], "infinity");
  EXPECT_EQ(values["[Service]DeviceAllow"], "/dev/cpu_dma_latency rw");
  EXPECT_EQ(values.count("[Service]RestrictRealtime"), 0U);
  // who preempts the tick, and the host's steal (docs/decisions/late_ticks.md)
  EXPECT_EQ(values["[Service]ProtectProc"], "default");
  EXPECT_EQ(values.count("[Service]ProcSubset"), 0U);
  EXPECT_THAT(values["[Service]ExecStart"], HasSubstr("/palpate-server --config "));
  // docs/decisions/service_watchdog.md
  EXPECT_EQ(values["[Service]Type"], "notify");
  EXPECT_GE(std::stoi(values["[Service]WatchdogSec"]), 1);
  EXPECT_EQ(values["[Service]Restart"], "on-failure");
  EXPECT_EQ(values["[Unit]StartLimitIntervalSec"], "0") << "it is started again however often it ends";
  EXPECT_EQ(values["[Service]ExecStart"].find('@'), std::string::npos) << "a place that was not filled in";
}

TEST(ServiceFiles, SystemdUnderstandsTheUnit) {
  if (!testing::isInstalled("systemd-analyze")) GTEST_SKIP() << "no systemd-analyze here";
  const testing::TemporaryFolder folder;
  const std::string copy = (folder / "palpate-server.service").string();
  std::string text = textOf(PALPATE_SERVICE_FILE);
  const std::size_t program = text.find("ExecStart=") + 10;
  text.replace(program, text.find(' ', program) - program, "/bin/true");  // ours is not installed
  std::ofstream(copy) << text;
  const std::string said = (folder / "systemd-analyze.txt").string();
  EXPECT_EQ(std::system(("systemd-analyze --man=no verify " + copy + " >" + said + " 2>&1").c_str()), 0);
  EXPECT_EQ(textOf(said), "");
}

TEST(ServiceFiles, TheLimitsGrantWhatTheThreadsWant) {
  std::istringstream lines(textOf(PALPATE_LIMITS_FILE));
  std::map<std::string, std::string> values;
  for (std::string line; std::getline(lines, line);) {
    if (line.empty() || line[0] == '#') continue;
    std::istringstream words(line);
    std::string who, kind, item, value, more;
    ASSERT_TRUE(words >> who >> kind >> item >> value) << line;
    EXPECT_FALSE(words >> more) << line;
    EXPECT_EQ(who, "@palpate");
    EXPECT_EQ(kind, "-");
    values[item] = value;
  }
  EXPECT_THAT(values, SizeIs(2));
  EXPECT_GE(std::stoi(values["rtprio"]), kTickPriority);
  EXPECT_EQ(values["memlock"], "unlimited");
}

}  // namespace
}  // namespace palpate::server
