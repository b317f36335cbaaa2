// SPDX-License-Identifier: Apache-2.0
// Makes ticks of the real server late, for causes that are known: it names at least 95 % of these very ticks right.
#include <gtest/gtest.h>
#include <pthread.h>
#include <sched.h>
#include <sys/types.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <ctime>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "late_injections.h"
#include "late_log.h"
#include "memory_group.h"
#include "palpate/idl/reader.h"
#include "palpate/testing/server_process.h"
#include "palpate/testing/synthetic_model.h"
#include "palpate/testing/test_domain.h"

namespace palpate::proof {
namespace {

using palpate::testing::ServerProcess;
using std::chrono::milliseconds;
using Count = std::uint64_t;

constexpr milliseconds kStall{8};
constexpr milliseconds kBetween{40};

void wait(milliseconds time) {
  std::this_thread::sleep_for(time);
}

std::int64_t nowUs() {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return static_cast<std::int64_t>(now.tv_sec) * 1'000'000 + now.tv_nsec / 1000;
}

std::string text(const dds::LateTicks& late) {
  return "unknown " + std::to_string(late.unknown) + ", own work " + std::to_string(late.own_work) +
         ", page fault " + std::to_string(late.page_fault) + ", preempted " + std::to_string(late.preempted) +
         " by " + late.preempted_by + ", stopped " + std::to_string(late.stopped) + ", host steal " +
         std::to_string(late.host_steal) + ", clock step " + std::to_string(late.clock_step);
}

// The CPUs that this process may use.
std::vector<int> usable() {
  cpu_set_t set;
  std::vector<int> cpus;
  if (sched_getaffinity(0, sizeof set, &set) != 0) return cpus;
  for (int cpu = 0; cpu < CPU_SETSIZE; ++cpu)
    if (CPU_ISSET(cpu, &set)) cpus.push_back(cpu);
  return cpus;
}

// A thread that has a CPU for itself, in bursts.
class Hog {
 public:
  explicit Hog(int cpu) : thread_([this, cpu] { granted_ = settle(cpu); }) { thread_.join(); }

  [[nodiscard]] bool granted() const { return granted_; }

  // @return its bursts
  std::vector<Injection> hog(int cpu) {
    std::vector<Injection> bursts;
    thread_ = std::thread([cpu, &bursts] {
      (void)settle(cpu);
      for (int i = 0; i < kInjections; ++i) {
        wait(kBetween);
        bursts.push_back({nowUs(), std::chrono::microseconds(kStall).count()});
        for (const std::int64_t end = ran() + kStall.count() * 1'000'000; ran() < end;) {
        }
      }
      wait(milliseconds(1500));  // still there when it is looked for
    });
    thread_.join();
    return bursts;
  }

 private:
  static bool settle(int cpu) {
    cpu_set_t set;
    CPU_ZERO(&set);
    CPU_SET(cpu, &set);
    sched_param parameters{};
    parameters.sched_priority = 90;  // above the tick's 80
    pthread_setname_np(pthread_self(), "cpu-hog");
    return sched_setaffinity(0, sizeof set, &set) == 0 &&
           pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameters) == 0;
  }
  static std::int64_t ran() {
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return static_cast<std::int64_t>(now.tv_sec) * 1'000'000'000 + now.tv_nsec;
  }

  bool granted_{false};
  std::thread thread_;
};

class LateTicks : public ::testing::Test {
 protected:
  // A server, from which a status has come. @param[in] cause  for the library late_injector; empty: without it
  void start(std::string_view cause, std::vector<std::string> more = {}) {
    palpate::testing::writeSyntheticModel(model_.path(), {.modes = 24});
    std::vector<std::string> arguments{"--model", model_.path().string(), "--domain",
                                       std::to_string(domain_)};
    arguments.insert(arguments.end(), more.begin(), more.end());
    if (!cause.empty()) {
      setenv("LD_PRELOAD", PALPATE_PROOF_DIR "/libpalpate_late_injector.so", 1);
      setenv(kLateCauseVariable, std::string(cause).c_str(), 1);
    }
    setenv("SPDLOG_LEVEL", "debug", 1);  // each late tick
    server_ = std::make_unique<ServerProcess>(arguments);
    unsetenv("SPDLOG_LEVEL");
    unsetenv("LD_PRELOAD");
    unsetenv(kLateCauseVariable);
    const auto first = waitFor([](const dds::ServerStatus& status) { return status.ticks > 100; });
    ASSERT_TRUE(first.has_value()) << server_->log();
    before_ = *first;
  }

  template <class Wanted>
  std::optional<dds::ServerStatus> waitFor(Wanted wanted) {
    dds::ServerStatus status;
    for (int i = 0; i < 1500; ++i, wait(milliseconds(20)))
      if (statuses_.take({&status, 1}) == 1 && wanted(status)) return status;
    return std::nullopt;
  }

  // Injects, waits until all that is judged, and looks how the tick of each injection was named. A tick that a busy machine made
  // later than the injection is not held against the server; then it injects again.
  // @param[in] inject  returns what it injected
  template <class Inject>
  void expectNamed(Count dds::LateTicks::*cause, const std::string& word, Inject inject) {
    std::vector<Injection> injected;
    Named named;
    for (int tries = 0; tries < 5 && named.clear < kInjections / 2; ++tries) {
      const std::vector<Injection> more = inject();
      ASSERT_EQ(more.size(), static_cast<std::size_t>(kInjections)) << server_->log();
      injected.insert(injected.end(), more.begin(), more.end());
      ASSERT_NO_FATAL_FAILURE(judge());
      named = compare(injected, toldTicks(server_->log()), word);
    }
    RecordProperty("right", std::to_string(named.right) + " of " + std::to_string(named.clear));
    EXPECT_GE(100 * named.right, 95 * named.clear) << named.wrongly;
    EXPECT_GE(after_.late.*cause - before_.late.*cause, static_cast<Count>(named.right)) << text(after_.late);
    if (named.clear < kInjections / 2 && !before_.realtime)
      GTEST_SKIP()
          << "without a real-time priority other threads kept the ticks for longer than the injections";
    EXPECT_GE(named.clear, kInjections / 2) << text(after_.late);
  }

  // By the library, which tells of each.
  std::vector<Injection> injectInside() {
    const auto before = static_cast<std::ptrdiff_t>(injections(server_->log()).size());
    server_->signal(SIGUSR2);
    std::vector<Injection> all = injections(server_->log());
    for (int i = 0; i < 1500 && std::ssize(all) < before + kInjections; ++i) {
      wait(milliseconds(20));
      all = injections(server_->log());
    }
    return {all.begin() + before, all.end()};
  }

  // A status in which all late ticks of before are judged: some are held back for a second.
  void judge() {
    wait(milliseconds(1200));
    dds::ServerStatus older;
    while (statuses_.take({&older, 1}) == 1) {
    }
    const auto status = waitFor([](const dds::ServerStatus&) { return true; });
    ASSERT_TRUE(status.has_value()) << server_->log();
    after_ = *status;
  }

  const std::uint32_t domain_ = palpate::testing::exclusiveDomain();
  const palpate::testing::TemporaryFile model_{"late.h5"};
  const dds::Participant participant_{domain_};
  const dds::Reader<dds::ServerStatus> statuses_{participant_};
  std::optional<MemoryGroup> group_;  // before the server, which is in it: it is removed once it is empty
  std::unique_ptr<ServerProcess> server_;
  dds::ServerStatus before_{}, after_{};
};

TEST_F(LateTicks, OfOwnWorkAreNamed) {
  ASSERT_NO_FATAL_FAILURE(start(kWork));
  expectNamed(&dds::LateTicks::own_work, "own work", [this] { return injectInside(); });
}

TEST_F(LateTicks, OfPageFaultsAreNamed) {
  ASSERT_NO_FATAL_FAILURE(start(kFault));
  expectNamed(&dds::LateTicks::page_fault, "page fault", [this] { return injectInside(); });
}

TEST_F(LateTicks, OfPagesThatHaveToBeReadAreNamed) {
  const FileOnDisk file(PALPATE_PROOF_DIR "/late_pages", std::size_t{16} << 20);
  setenv(kLateFileVariable, file.path().c_str(), 1);
  ASSERT_NO_FATAL_FAILURE(start(kRead));
  unsetenv(kLateFileVariable);
  expectNamed(&dds::LateTicks::page_fault, "page fault", [this] { return injectInside(); });
}

// The ticks' fresh pages, in a group whose memory another process keeps full: who faults has to free pages first.
TEST_F(LateTicks, OfPageFaultsWhereMemoryIsShortAreNamed) {
  constexpr std::size_t kBytes = std::size_t{40} << 20;
  group_.emplace(kBytes);
  const MemoryGroup& group = *group_;
  if (!group.granted()) GTEST_SKIP() << "no control group that bounds memory may be made here";
  ASSERT_NO_FATAL_FAILURE(start(kFault));
  ASSERT_TRUE(group.take(server_->pid()));
  const FileOnDisk file(PALPATE_PROOF_DIR "/late_hog", 4 * kBytes);
  const MemoryHog hog(group, file.path());
  for (int i = 0; i < 500 && group.timesFull() == 0; ++i) wait(milliseconds(20));
  const long long before = group.timesFull();
  ASSERT_GT(before, 0);
  expectNamed(&dds::LateTicks::page_fault, "page fault", [this] { return injectInside(); });
  RecordProperty("times_full", std::to_string(group.timesFull() - before));
  EXPECT_GT(group.timesFull(), before) << "memory was short all the time";
}

TEST_F(LateTicks, OfAClockThatLeapsAreNamed) {
  ASSERT_NO_FATAL_FAILURE(start(kLeap));
  expectNamed(&dds::LateTicks::clock_step, "clock step", [this] { return injectInside(); });
}

TEST_F(LateTicks, OfAStoppedProcessAreNamed) {
  ASSERT_NO_FATAL_FAILURE(start({}));
  expectNamed(&dds::LateTicks::stopped, "stopped", [this] {
    std::vector<Injection> stops;
    for (int i = 0; i < kInjections; ++i) {
      wait(kBetween);
      const std::int64_t at_us = nowUs();
      server_->signal(SIGSTOP);
      wait(kStall);
      server_->signal(SIGCONT);
      stops.push_back({at_us, nowUs() - at_us});
    }
    return stops;
  });
}

TEST_F(LateTicks, OfAThreadWithAHigherPriorityAreNamedAndSoIsTheThread) {
  const std::vector<int> cpus = usable();
  const int cpu = cpus.empty() ? 0 : cpus.back();
  Hog hog(cpu);
  if (!hog.granted()) GTEST_SKIP() << "SCHED_FIFO is not granted here: no thread can be put above the tick";
  ASSERT_NO_FATAL_FAILURE(start({}, {"--tick-cpu", std::to_string(cpu)}));
  if (!before_.realtime) GTEST_SKIP() << "the server's tick has no real-time priority here";
  expectNamed(&dds::LateTicks::preempted, "preempted by cpu-hog (", [&] { return hog.hog(cpu); });
  EXPECT_NE(std::string(after_.late.preempted_by), "");
}

TEST_F(LateTicks, AreNotCausedByTheWallClockWhichIsReportedByItself) {
  ASSERT_NO_FATAL_FAILURE(start(kWall));
  expectNamed(&dds::LateTicks::own_work, "own work", [this] { return injectInside(); });
  EXPECT_EQ(after_.clock_steps, 1U);
  EXPECT_NEAR(after_.clock_step_s, 2.0, 0.01);
  EXPECT_EQ(after_.late.clock_step, 0U) << text(after_.late);
}

}  // namespace
}  // namespace palpate::proof
