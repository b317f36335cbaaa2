// SPDX-License-Identifier: Apache-2.0
#include "palpate/server/machine_check.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <filesystem>

#include "palpate/server/config.h"
#include "palpate/testing/files.h"

namespace palpate::server {
namespace {

using ::testing::HasSubstr;
namespace fs = std::filesystem;

/// A made-up machine: by default one that is prepared, CPU 3 for the tick.
class Machine {
 public:
  Machine() {
    write("proc/version", "Linux version 6.1.0-18-rt-amd64 (debian) #1 SMP PREEMPT_RT Debian\n");
    write("sys/kernel/realtime", "1\n");
    write("sys/devices/system/cpu/isolated", "2-3\n");
    write("proc/irq/24/smp_affinity_list", "0-3\n");
    write("proc/irq/24/effective_affinity_list", "0\n");
    write("proc/irq/default_smp_affinity", "f\n");
    write("proc/sys/kernel/sched_rt_runtime_us", "950000\n");
    write("proc/sys/kernel/sched_rt_period_us", "1000000\n");
    write("sys/devices/system/cpu/cpu3/cpufreq/scaling_governor", "performance\n");
    write("sys/devices/system/cpu/cpu0/cpufreq/scaling_governor", "powersave\n");
    write("proc/self/limits",
          "Limit                     Soft Limit           Hard Limit           Units     \n"
          "Max locked memory         unlimited            unlimited            bytes     \n"
          "Max realtime priority     90                   90                   \n");
    write("proc/self/status", "Name:\tpalpate-server\nCapEff:\t0000000000000000\n");
    write("dev/cpu_dma_latency", "");
  }
  void write(const std::string& file, const std::string& text) const {
    fs::create_directories((root_ / file).parent_path());
    root_.write(file, text);
  }
  void remove(const std::string& file) const { fs::remove_all(root_ / file); }
  [[nodiscard]] std::vector<MachineCheck> all(std::int64_t tick_cpu = 3) const {
    return checkMachine(root_.path(), tick_cpu);
  }
  [[nodiscard]] MachineCheck check(const std::string& key, std::int64_t tick_cpu = 3) const {
    for (const MachineCheck& check : all(tick_cpu))
      if (check.key == key) return check;
    ADD_FAILURE() << "no " << key;
    return {};
  }

 private:
  palpate::testing::TemporaryFolder root_;
};

void expectBetter(const MachineCheck& check, const std::string& found, const std::string& remedy) {
  EXPECT_EQ(check.suits, Suits::kCouldBeBetter) << check.key;
  EXPECT_THAT(check.found, HasSubstr(found));
  EXPECT_THAT(check.remedy, HasSubstr(remedy));
}

TEST(MachineCheck, AMachineThatIsPreparedIsOkInAll) {
  const Machine machine;
  EXPECT_EQ(machine.all().size(), 8U);
  for (const MachineCheck& check : machine.all()) {
    EXPECT_EQ(check.suits, Suits::kOk) << check.key << ": " << check.found;
    EXPECT_TRUE(check.remedy.empty()) << check.key;
  }
  EXPECT_TRUE(grantsRealtime(machine.all()));
}

TEST(MachineCheck, WhatCannotBeReadIsUnknown) {
  const palpate::testing::TemporaryFolder empty;
  for (const MachineCheck& check : checkMachine(empty.path(), 3))
    EXPECT_EQ(check.suits, Suits::kUnknown) << check.key << ": " << check.found;
  EXPECT_FALSE(grantsRealtime(checkMachine(empty.path(), 3)));
}

TEST(MachineCheck, TellsAKernelWithoutPreemption) {
  const Machine machine;
  machine.remove("sys/kernel/realtime");
  EXPECT_EQ(machine.check("kernel").suits, Suits::kOk) << "its name says it";
  machine.write("proc/version", "Linux version 6.1.0-18-amd64 (debian) #1 SMP PREEMPT_DYNAMIC Debian\n");
  expectBetter(machine.check("kernel"), "no PREEMPT_RT: 6.1.0-18-amd64", "linux-image-rt-amd64");
}

TEST(MachineCheck, TellsACpuThatIsNotIsolated) {
  const Machine machine;
  expectBetter(machine.check("isolated_cpus", 1), "2-3", "isolcpus=1");
  expectBetter(machine.check("isolated_cpus", kAnyCpu), "2-3, and no --tick-cpu", "--tick-cpu");
  machine.write("sys/devices/system/cpu/isolated", "\n");
  expectBetter(machine.check("isolated_cpus"), "none", "isolcpus=3");
  machine.write("sys/devices/system/cpu/isolated", "1,3,5-6\n");
  for (const int cpu : {1, 3, 5, 6}) EXPECT_EQ(machine.check("isolated_cpus", cpu).suits, Suits::kOk) << cpu;
  for (const int cpu : {0, 2, 4, 7}) EXPECT_NE(machine.check("isolated_cpus", cpu).suits, Suits::kOk) << cpu;
}

TEST(MachineCheck, CountsInterruptsThatComeToTheTicksCpu) {
  const Machine machine;
  machine.write("proc/irq/30/effective_affinity_list", "2-3\n");
  machine.write("proc/irq/7/smp_affinity_list", "3\n");  // a kernel that does not say the effective one
  expectBetter(machine.check("interrupts"), "2 come to CPU 3: 7, 30", "/proc/irq/NUMBER/smp_affinity_list");
  EXPECT_EQ(machine.check("interrupts", 1).suits, Suits::kOk);
  EXPECT_EQ(machine.check("interrupts", kAnyCpu).suits, Suits::kUnknown);
}

TEST(MachineCheck, ThrottlingMayBeOffButNotNearlyAll) {
  const Machine machine;
  machine.write("proc/sys/kernel/sched_rt_runtime_us", "-1\n");
  EXPECT_EQ(machine.check("throttling").found, "off");
  machine.write("proc/sys/kernel/sched_rt_runtime_us", "100000\n");
  expectBetter(machine.check("throttling"), "100000 of 1000000 us", "sched_rt_runtime_us=950000");
}

TEST(MachineCheck, TheGovernorOfTheTicksCpuCountsOrThoseOfAll) {
  const Machine machine;
  expectBetter(machine.check("governor", 0), "cpu0 has powersave", "performance");
  expectBetter(machine.check("governor", kAnyCpu), "cpu0 has powersave", "performance");
  EXPECT_EQ(machine.check("governor", 1).suits, Suits::kUnknown) << "it has none";
}

TEST(MachineCheck, LimitsBindWhereNoCapabilityDoesNot) {
  const Machine machine;
  machine.write("proc/self/limits",
                "Max locked memory         8388608              8388608              bytes     \n"
                "Max realtime priority     0                    0                    \n");
  expectBetter(machine.check("memory_lock"), "at most 8388608 bytes", "LimitMEMLOCK=infinity");
  expectBetter(machine.check("priority"), "at most 0, the tick wants 80", "LimitRTPRIO=90");
  EXPECT_FALSE(grantsRealtime(machine.all()));
  machine.write("proc/self/status", "CapEff:\t0000000000804000\n");  // CAP_SYS_NICE, CAP_IPC_LOCK
  EXPECT_EQ(machine.check("memory_lock").found, "CAP_IPC_LOCK");
  EXPECT_EQ(machine.check("priority").found, "CAP_SYS_NICE");
  EXPECT_TRUE(grantsRealtime(machine.all()));
}

// The server starts without locked memory, and warns.
TEST(MachineCheck, OnlyThePriorityIsRequired) {
  const Machine machine;
  machine.write("proc/self/limits",
                "Max locked memory         8388608              8388608              bytes     \n"
                "Max realtime priority     90                   90                   \n");
  EXPECT_EQ(machine.check("memory_lock").suits, Suits::kCouldBeBetter);
  EXPECT_TRUE(grantsRealtime(machine.all()));
  machine.write("proc/self/limits",
                "Max locked memory         unlimited            unlimited            bytes     \n"
                "Max realtime priority     79                   79                   \n");
  EXPECT_FALSE(grantsRealtime(machine.all()));
}

TEST(MachineCheck, TheTextHasALineForEachAndOneForEachRemedy) {
  const Machine machine;
  machine.write("sys/devices/system/cpu/isolated", "\n");
  const std::string text = textOf(machine.all());
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 9) << text;
  EXPECT_THAT(text, HasSubstr("isolated CPUs         could be better  none\n"));
}

}  // namespace
}  // namespace palpate::server
