// SPDX-License-Identifier: Apache-2.0
#include "palpate/rt/thread_reading.h"

#include <gtest/gtest.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cstdlib>
#include <ctime>

namespace palpate::rt {
namespace {

TEST(ThreadReading, CountsTimePagesAndSleeps) {
  const ThreadReading before = readThisThread();
  constexpr std::size_t kPages = 40, kPage = 4096;
  void* const memory =
      mmap(nullptr, kPages * kPage, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  ASSERT_NE(memory, MAP_FAILED);
  madvise(memory, kPages * kPage, MADV_NOHUGEPAGE);
  for (std::size_t i = 0; i < kPages; ++i) static_cast<volatile char*>(memory)[i * kPage] = 1;
  munmap(memory, kPages * kPage);
  const timespec pause{0, 5'000'000};
  nanosleep(&pause, nullptr);
  const ThreadReading after = readThisThread();
  EXPECT_GE(after.minor_faults - before.minor_faults, 40);
  EXPECT_GE(after.waits - before.waits, 1);
  EXPECT_GE(after.at_ns - before.at_ns, 5'000'000);
  EXPECT_GT(after.cpu_ns, before.cpu_ns);
  EXPECT_LE(after.cpu_ns - before.cpu_ns, after.at_ns - before.at_ns);
  EXPECT_LT(std::llabs((after.raw_ns - before.raw_ns) - (after.at_ns - before.at_ns)), 1'000'000);
  EXPECT_GE(after.cpu, 0);
}

TEST(RunQueueFile, SaysWhatTheThreadWaitedAndNothingOfOneThatIsNotThere) {
  const RunQueueFile own;
  const RunQueueFile same(gettid());
  const RunQueueFile none(1'999'999'999);
  if (own.queued_ns() < 0) GTEST_SKIP() << "this kernel has no /proc/thread-self/schedstat";
  const std::int64_t before = own.queued_ns();
  EXPECT_GE(same.queued_ns(), before);
  EXPECT_EQ(none.queued_ns(), -1);
}

}  // namespace
}  // namespace palpate::rt
