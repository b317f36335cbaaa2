// SPDX-License-Identifier: Apache-2.0
#include "palpate/rt/spin_guard.h"

#include <gtest/gtest.h>
#include <pthread.h>
#include <sched.h>
#include <sys/resource.h>

#include <atomic>
#include <csignal>
#include <ctime>
#include <string_view>

#include "palpate/rt/clock.h"
#include "palpate/rt/scheduling.h"
#include "palpate/rt/thread.h"

namespace palpate::rt {
namespace {

using std::chrono::milliseconds;

/// A real-time thread that computes until it is told to stop, beside one that sleeps each millisecond.
class Spinner {
 public:
  Spinner()
      : sleeper_({"sleeper", 2, RealtimePolicy::kPrefer, {}},
                 [this] {
                   while (!stop_.load()) sleepUntil(monotonicNow() + 1'000'000);
                 }),
        spinner_({"spinner", 1, RealtimePolicy::kPrefer, {}}, [this] {
          while (!stop_.load()) {
          }
        }) {}
  ~Spinner() { stop_ = true; }
  [[nodiscard]] bool realtime() const { return spinner_.realtime(); }

 private:
  std::atomic<bool> stop_{false};
  Thread sleeper_, spinner_;
};

// Blocked in this thread and in those that it makes, as the server does.
bool signalComes(milliseconds within) {
  sigset_t spins;
  sigemptyset(&spins);
  sigaddset(&spins, SIGXCPU);
  const timespec time = toTimespec(std::chrono::nanoseconds(within).count());
  return sigtimedwait(&spins, nullptr, &time) == SIGXCPU;
}

class SpinGuard : public ::testing::Test {
 protected:
  SpinGuard() {
    sigset_t spins;
    sigemptyset(&spins);
    sigaddset(&spins, SIGXCPU);
    pthread_sigmask(SIG_BLOCK, &spins, nullptr);
  }
};

TEST_F(SpinGuard, AThreadThatNeverSleepsIsSignalledAndFound) {
  ASSERT_EQ(limitRealtimeWithoutSleep(milliseconds(100), milliseconds(60'000)), 0);
  const Spinner threads;
  if (!threads.realtime()) GTEST_SKIP() << "SCHED_FIFO is not granted here";
  ASSERT_TRUE(signalComes(milliseconds(20'000)));
  std::vector<ThreadFacts> found;
  for (int look = 0; look < 50 && found.empty();
       ++look)  // others of a higher priority may keep it from spinning
    found = spinningThreads(milliseconds(100));
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].name, "spinner");
  ASSERT_EQ(lowerThread(found[0]), 0);
  EXPECT_EQ(sched_getscheduler(found[0].id), SCHED_OTHER);
  constexpr std::string_view kSpinner[] = {"spinner"};
  EXPECT_EQ(raiseThreadsNamed(kSpinner, 1), 0U) << "it stays lowered";
  EXPECT_TRUE(spinningThreads(milliseconds(20)).empty()) << "an ordinary thread may compute";
  ASSERT_EQ(limitRealtimeWithoutSleep(milliseconds(100), milliseconds(60'000)), 0);
  (void)signalComes(milliseconds(0));
  EXPECT_FALSE(signalComes(milliseconds(300)));
}

TEST_F(SpinGuard, TheLimitIsSetAgainAfterTheKernelHasRaisedIt) {
  ASSERT_EQ(limitRealtimeWithoutSleep(milliseconds(1100), milliseconds(60'000)), 0);
  ASSERT_EQ(limitRealtimeWithoutSleep(milliseconds(100), milliseconds(60'000)), 0);
  rlimit limit{};
  ASSERT_EQ(getrlimit(RLIMIT_RTTIME, &limit), 0);
  EXPECT_EQ(limit.rlim_cur, 100'000U);
  EXPECT_EQ(limit.rlim_max, 60'000'000U);
}

}  // namespace
}  // namespace palpate::rt
