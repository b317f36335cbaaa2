// SPDX-License-Identifier: Apache-2.0
#include "palpate/server/urgent_mappings.h"

#include <gtest/gtest.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstddef>
#include <functional>
#include <thread>

namespace palpate::server {
namespace {

constexpr std::size_t kBytes = std::size_t{32} << 20U;

void* map(std::size_t bytes, int flags = 0) {
  return mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | flags, -1, 0);
}

// Whether this thread is seen with a real-time priority while `call` runs, again and again for at most so long. `before` is not
// watched.
bool isSeenUrgent(const std::function<void()>& before, const std::function<void()>& call,
                  std::chrono::milliseconds longest = std::chrono::seconds(3)) {
  std::atomic<bool> watching{false}, seen{false}, ended{false};
  const pid_t thread = gettid();
  std::thread watcher([&] {
    while (!ended)
      if (watching && sched_getscheduler(thread) == SCHED_FIFO && watching) seen = true;
  });
  const auto until = std::chrono::steady_clock::now() + longest;
  while (!seen && std::chrono::steady_clock::now() < until) {
    before();
    watching = true;
    call();
    watching = false;
  }
  ended = true;
  watcher.join();
  return seen;
}

class UrgentMappings : public ::testing::Test {
 protected:
  void SetUp() override {
    const sched_param lowest{1}, none{0};
    if (sched_setscheduler(0, SCHED_FIFO, &lowest) != 0) GTEST_SKIP() << "SCHED_FIFO is not granted here";
    ASSERT_EQ(sched_setscheduler(0, SCHED_OTHER, &none), 0);
    urgent_mappings = true;
  }
  void TearDown() override { urgent_mappings = false; }
};

TEST_F(UrgentMappings, AThreadHasARealTimePriorityOnlyWhileItMapsUnmapsOrLocks) {
  if (std::thread::hardware_concurrency() < 2) GTEST_SKIP() << "nobody can look meanwhile on one processor";
  std::thread([] {
    ASSERT_EQ(setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), 10), 0);
    void* begin = nullptr;
    const auto make = [&] { begin = map(kBytes, MAP_POPULATE); };
    const auto unmap = [&] { munmap(begin, kBytes); };
    make();
    EXPECT_TRUE(isSeenUrgent(unmap, make)) << "mmap";
    unmap();
    EXPECT_TRUE(isSeenUrgent(make, unmap)) << "munmap";
    begin = map(kBytes);
    EXPECT_TRUE(isSeenUrgent(
        [&] {
          munlock(begin, kBytes);
          madvise(begin, kBytes, MADV_DONTNEED);
        },
        [&] { EXPECT_EQ(mlock(begin, kBytes), 0); }))
        << "mlock";
    unmap();
    EXPECT_EQ(sched_getscheduler(0), SCHED_OTHER);
    EXPECT_EQ(getpriority(PRIO_PROCESS, static_cast<id_t>(gettid())), 10) << "as nice as before";
  }).join();
}

TEST_F(UrgentMappings, ARealTimeThreadKeepsItsPriority) {
  std::thread([] {
    const sched_param mine{7};
    ASSERT_EQ(sched_setscheduler(0, SCHED_FIFO, &mine), 0);
    munmap(map(kBytes), kBytes);
    sched_param left{};
    ASSERT_EQ(sched_getparam(0, &left), 0);
    EXPECT_EQ(sched_getscheduler(0), SCHED_FIFO);
    EXPECT_EQ(left.sched_priority, 7);
  }).join();
}

TEST_F(UrgentMappings, WithoutRealTimeForcesNobodyIsRaised) {
  if (std::thread::hardware_concurrency() < 2) GTEST_SKIP() << "nobody can look meanwhile on one processor";
  urgent_mappings = false;
  const auto map_and_unmap = [] { munmap(map(kBytes, MAP_POPULATE), kBytes); };
  EXPECT_FALSE(isSeenUrgent([] {}, map_and_unmap, std::chrono::milliseconds(500)));
}

std::atomic<int> told_to_stop{0};

// Of all exchanges of organs together the kernel would count seconds, and end the server.
TEST_F(UrgentMappings, NoMatterHowManyAreNoSpinning) {
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_RTTIME, &before), 0);
  const rlimit tenth{100'000, before.rlim_max};  // us
  ASSERT_EQ(setrlimit(RLIMIT_RTTIME, &tenth), 0);
  std::signal(SIGXCPU, [](int) { ++told_to_stop; });
  const auto ran = [] {
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
  };
  for (const double end = ran() + 1.0; ran() < end;) munmap(map(kBytes / 4, MAP_POPULATE), kBytes / 4);
  std::signal(SIGXCPU, SIG_DFL);
  EXPECT_EQ(setrlimit(RLIMIT_RTTIME, &before), 0);
  EXPECT_EQ(told_to_stop, 0);
}

TEST_F(UrgentMappings, ErrnoSaysWhatFailedAndNothingElse) {
  errno = 0;
  EXPECT_EQ(map(0), MAP_FAILED);
  EXPECT_EQ(errno, EINVAL);
  errno = ENOTTY;
  munmap(map(kBytes), kBytes);
  EXPECT_EQ(errno, ENOTTY);
}

}  // namespace
}  // namespace palpate::server
