// SPDX-License-Identifier: Apache-2.0
// Makes ticks of the real server late, for causes that are known: it names at least 95 % of them right.
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
#include "palpate/idl/reader.h"
#include "palpate/testing/server_process.h"
#include "palpate/testing/synthetic_model.h"
#include "palpate/testing/test_domain.h"

namespace palpate::proof {
namespace {

using palpate::testing::ServerProcess;
using std::chrono::milliseconds;
using Count = std::uint64_t;

constexpr Count kNamedRight = kInjections * 95 / 100;
constexpr milliseconds kStall{8};
constexpr milliseconds kBetween{40};

void wait(milliseconds time) {
  std::this_thread::sleep_for(time);
}

Count totalOf(const dds::LateTicks& late) {
  return late.unknown + late.own_work + late.page_fault + late.preempted + late.stopped + late.host_steal +
         late.clock_step;
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

  void hog(int cpu, int bursts) {
    thread_ = std::thread([cpu, bursts] {
      (void)settle(cpu);
      for (int i = 0; i < bursts; ++i) {
        wait(kBetween);
        for (const std::int64_t end = ran() + kStall.count() * 1'000'000; ran() < end;) {
        }
      }
      wait(milliseconds(1500));  // still there when it is looked for
    });
    thread_.join();
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
    server_ = std::make_unique<ServerProcess>(arguments);
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

  // Injects and waits until all that is judged. Where the host took time meanwhile, a tick that was made late may be late by that
  // for the most part: then once more, at most twice.
  template <class Inject>
  void expectNamed(Count dds::LateTicks::*cause, Inject inject) {
    for (int tries = 1; tries <= 3; ++tries) {
      inject();
      ASSERT_NO_FATAL_FAILURE(judge());
      RecordProperty("after" + std::to_string(tries), text(after_.late));
      if (after_.late.*cause - before_.late.*cause >= kNamedRight) return;
      if (after_.late.host_steal == before_.late.host_steal) break;
      before_ = after_;
    }
    ADD_FAILURE() << kInjections << " were injected\nbefore: " << text(before_.late)
                  << "\nafter: " << text(after_.late);
  }

  void judge() {
    const Count all = totalOf(before_.late) + kInjections;
    const auto last = waitFor([all](const dds::ServerStatus& status) { return totalOf(status.late) >= all; });
    ASSERT_TRUE(last.has_value()) << server_->log();
    wait(milliseconds(1200));  // others held back for a second
    after_ = waitFor([](const dds::ServerStatus&) { return true; }).value_or(*last);
  }

  const std::uint32_t domain_ = palpate::testing::exclusiveDomain();
  const palpate::testing::TemporaryFile model_{"late.h5"};
  const dds::Participant participant_{domain_};
  const dds::Reader<dds::ServerStatus> statuses_{participant_};
  std::unique_ptr<ServerProcess> server_;
  dds::ServerStatus before_{}, after_{};
};

TEST_F(LateTicks, OfOwnWorkAreNamed) {
  ASSERT_NO_FATAL_FAILURE(start(kWork));
  expectNamed(&dds::LateTicks::own_work, [this] { server_->signal(SIGUSR2); });
}

TEST_F(LateTicks, OfPageFaultsAreNamed) {
  ASSERT_NO_FATAL_FAILURE(start(kFault));
  expectNamed(&dds::LateTicks::page_fault, [this] { server_->signal(SIGUSR2); });
}

TEST_F(LateTicks, OfAClockThatLeapsAreNamed) {
  ASSERT_NO_FATAL_FAILURE(start(kLeap));
  expectNamed(&dds::LateTicks::clock_step, [this] { server_->signal(SIGUSR2); });
}

TEST_F(LateTicks, OfAStoppedProcessAreNamed) {
  ASSERT_NO_FATAL_FAILURE(start({}));
  expectNamed(&dds::LateTicks::stopped, [this] {
    for (int i = 0; i < kInjections; ++i) {
      wait(kBetween);
      server_->signal(SIGSTOP);
      wait(kStall);
      server_->signal(SIGCONT);
    }
  });
}

TEST_F(LateTicks, OfAThreadWithAHigherPriorityAreNamedAndSoIsTheThread) {
  const std::vector<int> cpus = usable();
  const int cpu = cpus.empty() ? 0 : cpus.back();
  Hog hog(cpu);
  if (!hog.granted()) GTEST_SKIP() << "SCHED_FIFO is not granted here: no thread can be put above the tick";
  ASSERT_NO_FATAL_FAILURE(start({}, {"--tick-cpu", std::to_string(cpu)}));
  if (!before_.realtime) GTEST_SKIP() << "the server's tick has no real-time priority here";
  expectNamed(&dds::LateTicks::preempted, [&] { hog.hog(cpu, kInjections); });
  EXPECT_NE(std::string(after_.late.preempted_by).find("cpu-hog"), std::string::npos)
      << after_.late.preempted_by;
  EXPECT_NE(server_->log().find("preempted by cpu-hog ("), std::string::npos) << server_->log();
}

TEST_F(LateTicks, AreNotCausedByTheWallClockWhichIsReportedByItself) {
  ASSERT_NO_FATAL_FAILURE(start(kWall));
  server_->signal(SIGUSR2);
  const auto set = waitFor([](const dds::ServerStatus& status) { return status.clock_steps > 0; });
  ASSERT_TRUE(set.has_value()) << server_->log();
  EXPECT_EQ(set->clock_steps, 1U);
  EXPECT_NEAR(set->clock_step_s, 2.0, 0.01);
  EXPECT_EQ(set->late.clock_step, 0U) << text(set->late);
}

}  // namespace
}  // namespace palpate::proof
