// SPDX-License-Identifier: Apache-2.0
// What happens to the processes: killed, stopped, stuck, kept from their processor, short of memory and disk (docs/faults.md).
#include <sched.h>
#include <sys/mount.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <fstream>
#include <thread>

#include "../proof/memory_group.h"
#include "palpate/idl/reader.h"
#include "palpate/rt/process_threads.h"
#include "palpate/rt/scheduling.h"
#include "palpate/testing/run_program.h"
#include "recorded.h"
#include "rig.h"
#include "service_manager.h"
#include "stepped_clock.h"
#include "stuck_thread.h"

namespace palpate::faults {
namespace {

using rt::kMs;
constexpr double kRestart =
    6000.0;  // ms: a start, and a client that looks for the next server after a second of silence
constexpr double kRamps = 500.0;  // ms: DDS finds its way, and two ramps
constexpr std::chrono::microseconds kOften{300};
constexpr milliseconds kRestartAfter{100};  // RestartSec, where a unit has none

class ProcessFault : public Fault {
 protected:
  ~ProcessFault() override { server_.reset(); }  // before its group

  void restartLikeSystemd(const char* stuck);

  const palpate::testing::TemporaryFolder folder_;
  const std::filesystem::path recording_ = folder_ / "session.rec";
  std::optional<proof::MemoryGroup> group_;
};

TEST_F(ProcessFault, AKilledServerLeavesNoForceAndItsRecording) {
  int files = 0;
  const auto nextFile = [&] { return (folder_ / ("killed-" + std::to_string(++files) + ".rec")).string(); };
  ASSERT_NO_FATAL_FAILURE(start({"--record", nextFile()}));
  prepare_ = [&] {  // until it has written some, and has almost a second of more to lose
    for (int i = 0; i < 500 && read(server_arguments_.back()).ticks <= 500; ++i) wait(milliseconds(20));
    wait(milliseconds(800));
  };
  expect(
      "server: kill -9, started again", Force::kZero,
      [&] {
        const std::int64_t killed_ns = rt::monotonicNow();
        server_->signal(SIGKILL);
        (void)server_->waitForExit();
        const Recorded recorded = read(server_arguments_.back());
        recording_lacks_ms_ = ms(killed_ns - recorded.last_woke_ns);
        EXPECT_EQ(recorded.gaps, 0U);
        EXPECT_GT(recorded.ticks, 500U);
        server_arguments_.back() = nextFile();
        wait(kRestartAfter);
        startServer();
      },
      kRestart);
}

TEST_F(ProcessFault, AStoppedServerLeavesNoForceAndGoesOn) {
  ASSERT_NO_FATAL_FAILURE(start({"--record", recording_.string()}));
  expect(
      "server: SIGSTOP for 0.5 s", Force::kZero,
      [&] {
        server_->signal(SIGSTOP);
        wait(milliseconds(500));
        server_->signal(SIGCONT);
      },
      kRamps);
  if (IsSkipped()) return;
  server_->signal(SIGTERM);
  EXPECT_EQ(server_->waitForExit(), 0) << server_->log();
  const Recorded recorded = read(recording_);
  EXPECT_TRUE(recorded.ended);
  EXPECT_EQ(recorded.missing, 0U);
  EXPECT_EQ(recorded.gaps, 0U);
}

// A device that is not read renders what it was told last, which is its own watchdog's matter (docs/decisions/haptic_watchdog.md); the
// server's forces are zero by then, and so is what it reads first.
TEST_F(ProcessFault, AStoppedToolGetsNoForceFirst) {
  ASSERT_NO_FATAL_FAILURE(start());
  const dds::Participant participant(domain_);
  const dds::Reader<dds::ToolForce> forces(participant);
  ASSERT_TRUE(forces.waitForWriters(1, std::chrono::seconds(20)));
  const auto serversForceIsZero = [&] {
    dds::ToolForce force;
    if (forces.take({&force, 1}) != 1) return false;
    const auto& f = force.force;
    return f[0] == 0.0 && f[1] == 0.0 && f[2] == 0.0;
  };
  std::int64_t resumed_ns = 0;
  also_ = [&]() -> std::string {
    const std::vector<Sample> after = samplesSince(resumed_ns);
    if (after.empty()) return "nothing is read";
    const double first = after.front().force;
    return first == 0.0 ? "" : "what is read first is " + std::to_string(first) + " N";
  };
  expect(
      "tool: SIGSTOP for 0.2 s, the server's force", Force::kZero,
      [&] {
        const std::int64_t from_ns = rt::monotonicNow();
        device_->signal(SIGSTOP);
        server_zero_ms_ = {};
        for (; ms(rt::monotonicNow() - from_ns) < 200.0; std::this_thread::sleep_for(kOften))
          if (!server_zero_ms_ && serversForceIsZero()) server_zero_ms_ = ms(rt::monotonicNow() - from_ns);
        resumed_ns = rt::monotonicNow();
        device_->signal(SIGCONT);
      },
      kRamps);
}

// @param[in] stuck  as stuck_thread.h has it
void ProcessFault::restartLikeSystemd(const char* stuck) {
  constexpr milliseconds kPatience{3000};  // WatchdogSec of the unit
  std::unique_ptr<PlayedManager> manager;
  const auto startWatched = [&] {
    manager = std::make_unique<PlayedManager>(kPatience);
    setenv("LD_PRELOAD", PALPATE_FAULTS_DIR "/libpalpate_stuck_thread.so", 1);
    setenv(kStuckVariable, stuck, 1);
    startServer();
    unsetenv("LD_PRELOAD");
    PlayedManager::forget();
  };
  useArguments();
  startWatched();
  ASSERT_NO_FATAL_FAILURE(start());
  expect(
      std::string("server: ") + stuck + " stuck, restarted by systemd", Force::kZero,
      [&] {
        server_->signal(SIGUSR2);
        int signs = 0;
        while (manager->waitFor("WATCHDOG=1", kPatience)) ASSERT_LT(++signs, 5) << "it says that it lives";
        server_.reset();  // kills it
        wait(kRestartAfter);
        startWatched();
      },
      kRestart);
}

TEST_F(ProcessFault, AStuckTickLeavesNoForceAndIsStartedAgain) {
  restartLikeSystemd("tick");
}

TEST_F(ProcessFault, AStuckReceiveThreadLeavesNoForceAndIsStartedAgain) {
  restartLikeSystemd("recv");
}

TEST_F(ProcessFault, AThreadThatIsStuckSendingForcesLeavesNoneAndIsStartedAgain) {
  restartLikeSystemd("force-out");
}

TEST_F(ProcessFault, AWallClockThatStepsTakesNoForce) {
  setenv("LD_PRELOAD", PALPATE_FAULTS_DIR "/libpalpate_stepped_clock.so", 1);
  useArguments();
  startServer();
  unsetenv("LD_PRELOAD");
  ASSERT_NO_FATAL_FAILURE(start());
  const auto step = [&](const std::string& what, int signal, milliseconds time) {
    prepare_ = [&] {  // who waits then waits until a time of the clock before the step
      server_->signal(signal == SIGUSR2 ? SIGUSR1 : SIGUSR2);
      wait(milliseconds(1'000));
    };
    expect(
        "server: its wall clock " + what, Force::kGoesOn,
        [&] {
          server_->signal(signal);
          wait(time);
        },
        0.0);
  };
  step("an hour forward", SIGUSR2, milliseconds(2'000));
  EXPECT_NE(server_->log().find(kReadAhead), std::string::npos) << server_->log();
  // Who has begun to wait until a time of before waits an hour longer, and after 10 s DDS forgets whom it does not hear.
  step("an hour back", SIGUSR1, milliseconds(11'000));
}

// Keeps one processor for itself, above the tick. @return whether it was granted
bool hog(int cpu, milliseconds time) {
  bool granted = false;
  std::thread([&] {
    const std::array<int, 1> cpus{cpu};
    granted = rt::useCpus(cpus) == 0 && rt::raiseThisThread(90) == 0;
    for (const std::int64_t end_ns = rt::monotonicNow() + time.count() * kMs;
         granted && rt::monotonicNow() < end_ns;) {
    }
  }).join();
  return granted;
}

TEST_F(ProcessFault, AHogAboveTheTickLeavesNoForceOrTheTickMovesAway) {
  const std::vector<int> cpus = rt::usableCpus();
  if (cpus.size() < 2) GTEST_SKIP() << "one processor: a hog would keep the device from it too";
  if (!hog(cpus.back(), milliseconds(1)))
    GTEST_SKIP() << "SCHED_FIFO is not granted here: nothing can be put above the tick";
  stalls_ = std::make_unique<palpate::testing::Stalls>(std::span(cpus).first(1));
  startDevice({std::to_string(cpus.front())});
  ASSERT_NO_FATAL_FAILURE(start({"--tick-cpu", std::to_string(cpus.back())}));
  expect(
      "server: FIFO hog for 0.3 s on the tick's CPU", Force::kZero,
      [&] { (void)hog(cpus.back(), milliseconds(300)); }, kRamps);
  if (IsSkipped()) return;
  server_.reset();
  ASSERT_NO_FATAL_FAILURE(start());
  expect(
      "server: the same, a tick that may move", Force::kEither,
      [&] { (void)hog(cpus.back(), milliseconds(300)); }, kRamps);
}

TEST_F(ProcessFault, MemoryThatIsShortTakesNoForce) {
  constexpr std::size_t kBytes = std::size_t{40} << 20;
  const proof::MemoryGroup& group = group_.emplace(kBytes);
  if (!group.granted()) GTEST_SKIP() << "no control group that bounds memory may be made here";
  ASSERT_NO_FATAL_FAILURE(start({"--record", recording_.string()}));
  ASSERT_TRUE(group.take(server_->pid()));
  const proof::FileOnDisk file(PALPATE_FAULTS_DIR "/fault_hog", 4 * kBytes);
  const proof::MemoryHog hog(group, file.path());
  for (int i = 0; i < 500 && group.timesFull() == 0; ++i) wait(milliseconds(20));
  const long long before = group.timesFull();
  if (before == 0) GTEST_SKIP() << "not judged: the group's memory was not full within 10 s";
  expect(
      "server: its memory is full for 1 s", Force::kGoesOn, [&] { wait(milliseconds(1000)); }, kRamps);
  if (IsSkipped()) return;
  EXPECT_GT(group.timesFull(), before) << "memory was short all the time";
  server_->signal(SIGTERM);
  EXPECT_EQ(server_->waitForExit(), 0) << server_->log();
  const Recorded recorded = read(recording_);
  EXPECT_TRUE(recorded.ended);
  EXPECT_EQ(recorded.missing, 0U);
}

// Takes what is left of its disk.
void fill(const std::filesystem::path& path) {
  std::ofstream file(path, std::ios::binary);
  const std::string page(4096, 'x');
  while (file.write(page.data(), static_cast<std::streamsize>(page.size())).flush()) {
  }
}

TEST_F(ProcessFault, AFullDiskTakesNoForceAndWhatWasRecordedStays) {
  const std::filesystem::path disk = folder_.path() / "disk";
  std::filesystem::create_directory(disk);
  // Of this thread and its children only; gone with them.
  if (unshare(CLONE_NEWNS) != 0 || mount("none", "/", nullptr, MS_REC | MS_PRIVATE, nullptr) != 0 ||
      mount("none", disk.c_str(), "tmpfs", 0, "size=8m") != 0)
    GTEST_SKIP() << "no small file system may be mounted here";
  const std::filesystem::path filler = disk / "filler";
  int files = 0;
  prepare_ = [&] {
    server_.reset();
    std::filesystem::remove(filler);
    std::filesystem::remove(server_arguments_.back());  // of a try that was not judged
    server_arguments_.back() = (disk / (std::to_string(++files) + ".rec")).string();
    startServer();
  };
  useArguments({"--record", ""});
  startDevice();
  expect(
      "server: disk full under --record", Force::kGoesOn,
      [&] {
        // It reaches the disk once a second: the first part before the disk is full.
        for (int i = 0; i < 500 && read(server_arguments_.back()).ticks <= 200; ++i) wait(milliseconds(10));
        fill(filler);
        recording_lacks_ms_ = {};
        for (int i = 0; i < 500 && !recording_lacks_ms_; ++i, wait(milliseconds(10)))
          if (server_->log().find("recording ends early") != std::string::npos)
            recording_lacks_ms_ = ms(rt::monotonicNow() - read(server_arguments_.back()).last_woke_ns);
        ASSERT_TRUE(recording_lacks_ms_) << "it does not say that the recording ended: " << server_->log();
      },
      0.0);
  if (IsSkipped()) return;
  server_->signal(SIGTERM);
  EXPECT_EQ(server_->waitForExit(), 0) << server_->log();
  const Recorded recorded = read(server_arguments_.back());
  EXPECT_GT(recorded.ticks, 200U);
  EXPECT_EQ(recorded.gaps, 0U);
  (void)umount2(disk.c_str(), MNT_DETACH);
}

}  // namespace
}  // namespace palpate::faults
