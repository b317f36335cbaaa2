// SPDX-License-Identifier: Apache-2.0
#include "palpate/rt/cpu_rivals.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <fstream>

#include "palpate/rt/clock.h"

namespace palpate::rt {
namespace {

namespace fs = std::filesystem;

constexpr std::array<int, 1> kSecondCpu{1};

// A line of /proc/PID/task/TID/stat: field 39 is the processor, 40 the real-time priority, 41 the policy.
std::string statLine(int id, const std::string& name, int cpu, int priority, int policy) {
  std::string line = std::to_string(id) + " (" + name + ") R";
  for (int field = 4; field < 39; ++field) line += " 0";
  return line + " " + std::to_string(cpu) + " " + std::to_string(priority) + " " + std::to_string(policy) +
         " 0 0";
}

// A folder like /proc.
class FakeProc : public ::testing::Test {
 protected:
  FakeProc() { fs::create_directories(proc_ / "sys"); }
  ~FakeProc() override { fs::remove_all(proc_); }

  void thread(int process, int id, const std::string& name, int cpu, int priority,
              std::int64_t ran_ns) const {
    const fs::path task = proc_ / std::to_string(process) / "task" / std::to_string(id);
    fs::create_directories(task);
    std::ofstream(task / "stat") << statLine(id, name, cpu, priority, priority > 0 ? 1 : 0);
    std::ofstream(task / "schedstat") << ran_ns << " 5 6\n";
  }

  const fs::path proc_ = fs::temp_directory_path() / ("palpate-proc-" + std::to_string(getpid()));
};

TEST(ReadStat, ReadsNamesWithBlanksAndBrackets) {
  const auto thread = readStat(statLine(12, "a) (b", 3, 90, 1));
  ASSERT_TRUE(thread.has_value());
  EXPECT_EQ(thread->name, "a) (b");
  EXPECT_EQ(thread->cpu, 3);
  EXPECT_EQ(thread->priority, 90);
  EXPECT_FALSE(thread->deadline);
  EXPECT_TRUE(readStat(statLine(12, "x", 3, 0, 6))->deadline);
  EXPECT_FALSE(readStat("12 (cut) R 0 0"));
  EXPECT_FALSE(readStat(""));
}

TEST(ReadSteal, ReadsTheEighthNumberOfEachProcessor) {
  EXPECT_EQ(
      readSteal(
          "cpu  1 2 3 4 5 6 7 80 9 10\ncpu0 1 2 3 4 5 6 7 30 9 10\ncpu2 1 2 3 4 5 6 7 50 0 0\nintr 5\n"),
      (std::vector<std::int64_t>{30, 0, 50}));
  EXPECT_TRUE(readSteal("").empty());
}

TEST(MachineThread, NamesItself) {
  MachineThread thread{4711, 4711, "stress-ng", 1, 90, false, 0};
  EXPECT_EQ(thread.text(), "stress-ng (4711), FIFO 90");
  thread.id = 4713;
  thread.priority = 0;
  EXPECT_EQ(thread.text(), "stress-ng (4711/4713)");
}

TEST_F(FakeProc, TheThreadThatRanMostSinceTheLookBeforeIsNamed) {
  CpuRivals rivals(100, 80, proc_);
  thread(1, 1, "old", 1, 90, 5000 * kMs);
  thread(2, 2, "hog", 1, 85, 10 * kMs);
  rivals.look();
  EXPECT_FALSE(rivals.mostOn(kSecondCpu, 1)) << "what they ran before counts for nothing";
  thread(1, 1, "old", 1, 90, 5001 * kMs);
  thread(2, 2, "hog", 1, 85, 15 * kMs);
  rivals.look();
  ASSERT_TRUE(rivals.mostOn(kSecondCpu, kMs));
  EXPECT_EQ(rivals.mostOn(kSecondCpu, kMs)->name, "hog");
  EXPECT_FALSE(rivals.mostOn(kSecondCpu, 6 * kMs)) << "it ran less";
  EXPECT_FALSE(rivals.mostOn(std::array<int, 1>{0}, kMs)) << "it ran elsewhere";
}

TEST_F(FakeProc, OnlyThreadsThatMayKeepOursWaitingAreRivals) {
  CpuRivals real_time(100, 80, proc_);
  CpuRivals ordinary(100, 0, proc_);
  real_time.look();
  ordinary.look();
  thread(9, 100, "tick", 1, 80, 90 * kMs);
  thread(9, 101, "events", 1, 0, 80 * kMs);
  thread(8, 8, "low", 1, 79, 70 * kMs);
  thread(7, 7, "same", 1, 80, 60 * kMs);
  real_time.look();
  ordinary.look();
  EXPECT_EQ(real_time.mostOn(kSecondCpu, kMs)->name, "same");
  EXPECT_EQ(ordinary.mostOn(kSecondCpu, kMs)->text(), "events (9/101)");
}

TEST_F(FakeProc, WhatAThreadRanBeforeItWasRaisedDoesNotCount) {
  CpuRivals rivals(100, 80, proc_);
  thread(2, 2, "raised", 1, 0, 5000 * kMs);
  rivals.look();
  thread(2, 2, "raised", 1, 90, 5001 * kMs);
  thread(3, 3, "hog", 1, 85, 4 * kMs);
  rivals.look();
  ASSERT_TRUE(rivals.mostOn(kSecondCpu, kMs));
  EXPECT_EQ(rivals.mostOn(kSecondCpu, kMs)->name, "hog");
  thread(2, 2, "raised", 1, 90, 5008 * kMs);
  rivals.look();
  EXPECT_EQ(rivals.mostOn(kSecondCpu, kMs)->name, "raised");
}

TEST_F(FakeProc, AThreadThatIsGoneIsNotNamed) {
  CpuRivals rivals(100, 80, proc_);
  rivals.look();
  thread(2, 2, "hog", 1, 85, 15 * kMs);
  rivals.look();
  EXPECT_TRUE(rivals.mostOn(kSecondCpu, kMs));
  fs::remove_all(proc_ / "2");
  rivals.look();
  EXPECT_FALSE(rivals.mostOn(kSecondCpu, kMs));
}

TEST(CpuRivals, FindsThreadsOfThisMachine) {
  CpuRivals rivals(0, 0);
  rivals.look();
  volatile double x = 1.0;
  for (int i = 0; i < 30'000'000; ++i) x = x * 1.0000001;
  rivals.look();
  std::vector<int> cpus;
  for (int cpu = 0; cpu < 1024; ++cpu) cpus.push_back(cpu);
  EXPECT_TRUE(rivals.mostOn(cpus, kMs)) << "this test itself ran";
}

}  // namespace
}  // namespace palpate::rt
