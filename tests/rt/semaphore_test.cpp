// SPDX-License-Identifier: Apache-2.0
#include "palpate/rt/semaphore.h"

#include <gtest/gtest.h>

#include <thread>

namespace palpate::rt {
namespace {

TEST(Semaphore, EveryPostIsTakenOnce) {
  Semaphore semaphore;
  semaphore.post();
  semaphore.post();
  EXPECT_TRUE(semaphore.tryWait());
  EXPECT_TRUE(semaphore.tryWait());
  EXPECT_FALSE(semaphore.tryWait());
}

TEST(Semaphore, PostWakesAWaitingThread) {
  Semaphore there;
  Semaphore back;
  std::thread other([&] {
    for (int i = 0; i < 1000; ++i) {
      there.wait();
      back.post();
    }
  });
  for (int i = 0; i < 1000; ++i) {
    there.post();
    back.wait();
  }
  other.join();
  EXPECT_FALSE(there.tryWait());
  EXPECT_FALSE(back.tryWait());
}

TEST(Semaphore, WaitGivesUpWhenNobodyPosts) {
  Semaphore semaphore;
  const std::int64_t before = monotonicNow();
  EXPECT_FALSE(semaphore.waitFor(5'000'000));
  EXPECT_GE(monotonicNow() - before, 5'000'000);
  semaphore.post();
  EXPECT_TRUE(semaphore.waitFor(5'000'000));
}

}  // namespace
}  // namespace palpate::rt
