// SPDX-License-Identifier: Apache-2.0
// RealtimeSanitizer finds what a real-time function must not do: each of these functions does it, and the program ends.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <ctime>
#include <mutex>

#include "palpate/rt/clock.h"
#include "palpate/rt/periodic_thread.h"
#include "palpate/rt/semaphore.h"

namespace palpate::rt {
namespace {

std::mutex mutex;

// The compiler would refuse them (blocking_twins.cpp shows that): hidden from it, not from the sanitizer.
PALPATE_TRUSTED_BEGIN
void allocates() noexcept PALPATE_NONBLOCKING {
  void* volatile memory = std::malloc(100);
  std::free(memory);
}

void locks() noexcept PALPATE_NONBLOCKING {
  const std::lock_guard lock(mutex);
}

void sleeps() noexcept PALPATE_NONBLOCKING {
  const timespec pause{0, 1000};
  nanosleep(&pause, nullptr);
}

void opensAFile() noexcept PALPATE_NONBLOCKING {
  close(open("/dev/null", O_RDONLY | O_CLOEXEC));
}

// A cycle that calls what is not marked, which calls what blocks.
void innocent() noexcept {
  delete new int volatile(1);
}

std::int64_t cycleThatAllocatesInside(void* context, const Cycle& cycle) noexcept PALPATE_NONBLOCKING {
  if (cycle.index == 3) innocent();
  if (cycle.index == 10) static_cast<Semaphore*>(context)->post();
  return 0;
}
PALPATE_TRUSTED_END

void runCycles(PeriodicThread::Function function) {
  Semaphore done;
  PeriodicThread thread({"test-rtsan", 0, RealtimePolicy::kOff}, 1'000'000, function, &done);
  done.wait();
}

TEST(RealtimeSanitizerDeathTest, FindsAnAllocation) {
  EXPECT_DEATH(allocates(), "unsafe function `malloc` in real-time context");
}

TEST(RealtimeSanitizerDeathTest, FindsAMutex) {
  EXPECT_DEATH(locks(), "unsafe function `pthread_mutex_lock` in real-time context");
}

TEST(RealtimeSanitizerDeathTest, FindsASleep) {
  EXPECT_DEATH(sleeps(), "unsafe function `nanosleep` in real-time context");
}

TEST(RealtimeSanitizerDeathTest, FindsAFile) {
  EXPECT_DEATH(opensAFile(), "unsafe function `open` in real-time context");
}

TEST(RealtimeSanitizerDeathTest, FindsAnAllocationDeepInACycle) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_DEATH(runCycles(cycleThatAllocatesInside), "unsafe function `malloc` in real-time context");
}

TEST(RealtimeSanitizer, HasNothingAgainstAClockAndAPost) {
  const auto cycle = [](void* context, const Cycle& now) noexcept PALPATE_NONBLOCKING {
    if (now.index == 5 && monotonicNow() > 0) static_cast<Semaphore*>(context)->post();
    return std::int64_t{0};
  };
  runCycles(cycle);
}

}  // namespace
}  // namespace palpate::rt
