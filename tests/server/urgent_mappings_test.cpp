// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstddef>
#include <thread>

namespace palpate::server {
namespace {

constexpr std::size_t kBytes = std::size_t{64} << 20U;

// Maps and unmaps until it has been seen with a policy, or a hundred times. @param[in] wanted  the policy
bool isSeenWith(int wanted) {
  std::atomic<bool> seen{false}, ended{false};
  const pid_t thread = gettid();
  std::thread watcher([&] {
    while (!ended && !seen) seen = sched_getscheduler(thread) == wanted;
  });
  for (int i = 0; i < 100 && !seen; ++i) {
    void* const begin =
        mmap(nullptr, kBytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_POPULATE, -1, 0);
    EXPECT_NE(begin, MAP_FAILED);
    munmap(begin, kBytes);
  }
  ended = true;
  watcher.join();
  return seen;
}

TEST(UrgentMappings, AThreadHasARealTimePriorityOnlyWhileItMaps) {
  const sched_param lowest{1};
  if (sched_setscheduler(0, SCHED_FIFO, &lowest) != 0) GTEST_SKIP() << "SCHED_FIFO is not granted here";
  const sched_param none{0};
  ASSERT_EQ(sched_setscheduler(0, SCHED_OTHER, &none), 0);
  std::thread([] {
    ASSERT_EQ(setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), 10), 0);
    EXPECT_TRUE(isSeenWith(SCHED_FIFO));
    EXPECT_EQ(sched_getscheduler(0), SCHED_OTHER);
    EXPECT_EQ(getpriority(PRIO_PROCESS, static_cast<id_t>(gettid())), 10) << "as nice as before";
  }).join();
}

TEST(UrgentMappings, ARealTimeThreadKeepsItsPriority) {
  std::thread([] {
    const sched_param mine{7};
    if (sched_setscheduler(0, SCHED_FIFO, &mine) != 0) GTEST_SKIP() << "SCHED_FIFO is not granted here";
    void* const begin = mmap(nullptr, kBytes, PROT_READ, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    munmap(begin, kBytes);
    sched_param left{};
    ASSERT_EQ(sched_getparam(0, &left), 0);
    EXPECT_EQ(sched_getscheduler(0), SCHED_FIFO);
    EXPECT_EQ(left.sched_priority, 7);
  }).join();
}

TEST(UrgentMappings, WhatFailsSaysWhy) {
  errno = 0;
  EXPECT_EQ(mmap(nullptr, 0, PROT_READ, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0), MAP_FAILED);
  EXPECT_EQ(errno, EINVAL);
}

}  // namespace
}  // namespace palpate::server
