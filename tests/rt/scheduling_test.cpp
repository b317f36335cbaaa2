// SPDX-License-Identifier: Apache-2.0
#include "palpate/rt/scheduling.h"

#include <gtest/gtest.h>
#include <malloc.h>
#include <sched.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdlib>
#include <string>
#include <string_view>
#include <vector>

#include "palpate/rt/memory.h"
#include "palpate/rt/process_threads.h"
#include "palpate/rt/semaphore.h"
#include "palpate/rt/thread.h"

namespace palpate::rt {
namespace {

bool canRaise() {
  bool raised = false;
  Thread probe({"probe", 1, RealtimePolicy::kPrefer}, [&] { raised = sched_getscheduler(0) == SCHED_FIFO; });
  probe.join();
  return raised;
}

// Runs body in a child without root and without any real-time allowance. @return its exit code
template <class Body>
int withoutPrivilege(Body body) {
  const pid_t child = fork();
  if (child == 0) {
    const rlimit none{0, 0};
    setrlimit(RLIMIT_RTPRIO, &none);
    if (geteuid() == 0 && setuid(65534) != 0) _exit(99);
    _exit(body());
  }
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 98;
}

TEST(Thread, ThatHangsIsWaitedForOnlySoLong) {
  Semaphore go_on;
  Thread thread({"test-hangs"}, [&] { go_on.wait(); });
  EXPECT_FALSE(thread.joinWithin(std::chrono::milliseconds(20)));
  go_on.post();
  EXPECT_TRUE(thread.joinWithin(std::chrono::seconds(20)));
  EXPECT_TRUE(thread.joinWithin(std::chrono::milliseconds(0))) << "it is joined";
}

TEST(Thread, HasItsNameAndPriority) {
  if (!canRaise()) GTEST_SKIP() << "SCHED_FIFO is not granted here";
  std::string name(16, '\0');
  int policy = -1;
  sched_param parameters{};
  Thread thread({"test-named", 7, RealtimePolicy::kRequire}, [&] {
    pthread_getname_np(pthread_self(), name.data(), name.size());
    policy = sched_getscheduler(0);
    sched_getparam(0, &parameters);
  });
  EXPECT_TRUE(thread.realtime());
  thread.join();
  EXPECT_STREQ(name.c_str(), "test-named");
  EXPECT_EQ(policy, SCHED_FIFO);
  EXPECT_EQ(parameters.sched_priority, 7);
}

TEST(Thread, PolicyOffLeavesItAsOthersAre) {
  int policy = -1;
  Thread thread({"test-off", 7, RealtimePolicy::kOff}, [&] { policy = sched_getscheduler(0); });
  EXPECT_FALSE(thread.realtime());
  thread.join();
  EXPECT_EQ(policy, sched_getscheduler(0));
}

TEST(Thread, RequireRefusesWithoutPrivilegeAndNeverRunsTheBody) {
  const int code = withoutPrivilege([] {
    bool ran = false;
    try {
      Thread thread({"test-req", 7, RealtimePolicy::kRequire}, [&] { ran = true; });
    } catch (const RealtimeError& error) {
      const std::string_view text = error.what();
      const bool names_it = text.find("thread test-req: SCHED_FIFO priority 7 refused") == 0;
      return names_it && !ran ? 0 : 1;
    }
    return 2;
  });
  EXPECT_EQ(code, 0);
}

TEST(Thread, PreferRunsOnWithoutPrivilege) {
  const int code = withoutPrivilege([] {
    bool ran = false;
    Thread thread({"test-pref", 7, RealtimePolicy::kPrefer}, [&] { ran = true; });
    thread.join();
    return ran && !thread.realtime() ? 0 : 1;
  });
  EXPECT_EQ(code, 0);
}

TEST(RaiseThreadsNamed, RaisesExactlyTheNamedOnes) {
  if (!canRaise()) GTEST_SKIP() << "SCHED_FIFO is not granted here";
  std::array<int, 2> policy{-1, -1};
  Semaphore go_first;
  Semaphore go_second;
  Thread first({"test-recvUC", 0, RealtimePolicy::kOff}, [&] {
    go_first.wait();
    policy[0] = sched_getscheduler(0);
  });
  Thread second({"test-other", 0, RealtimePolicy::kOff}, [&] {
    go_second.wait();
    policy[1] = sched_getscheduler(0);
  });
  const std::array<std::string_view, 2> names{"test-recvUC", "no-such-thread"};
  EXPECT_EQ(raiseThreadsNamed(names, 5), 1U);
  EXPECT_EQ(raiseThreadsNamed(names, 5), 0U) << "it is there";
  go_first.post();
  go_second.post();
  first.join();
  second.join();
  EXPECT_EQ(policy[0], SCHED_FIFO);
  EXPECT_EQ(policy[1], sched_getscheduler(0));
}

TEST(Thread, RunsOnItsCpuAndNoOther) {
  const int cpu = usableCpus().back();
  std::vector<int> cpus;
  Thread thread({"test-cpu", 0, RealtimePolicy::kOff, {cpu}}, [&] { cpus = usableCpus(); });
  thread.join();
  EXPECT_EQ(cpus, std::vector<int>{cpu});
}

TEST(Thread, RefusesACpuThatIsNotThereAndNeverRunsTheBody) {
  bool ran = false;
  try {
    Thread thread({"test-cpu", 0, RealtimePolicy::kOff, {CPU_SETSIZE - 1}}, [&] { ran = true; });
    FAIL() << "accepted";
  } catch (const RealtimeError& error) {
    EXPECT_EQ(std::string(error.what()).find("thread test-cpu: CPUs 1023 refused ("), 0U) << error.what();
  }
  EXPECT_FALSE(ran);
}

TEST(ThreadsOfThisProcess, AreListedAsTheKernelHasThem) {
  const int cpu = usableCpus().front();
  Semaphore go;
  Thread thread({"test-listed", 0, RealtimePolicy::kOff, {cpu}}, [&] { go.wait(); });
  const std::vector<ThreadFacts> threads = threadsOfThisProcess();
  go.post();
  const auto found = std::find_if(threads.begin(), threads.end(),
                                  [](const ThreadFacts& t) { return t.name == "test-listed"; });
  ASSERT_NE(found, threads.end());
  EXPECT_EQ(found->fifo_priority, 0);
  EXPECT_EQ(found->cpus, std::vector<int>{cpu});
  EXPECT_EQ(threads.front().id, getpid());
}

TEST(CpuList, ShortensRuns) {
  EXPECT_EQ(cpuList({}), "");
  EXPECT_EQ(cpuList(std::vector<int>{0, 1, 2, 3, 6, 8, 9}), "0-3,6,8-9");
}

TEST(LockMemory, SaysWhyWhenRefused) {
  const int code = withoutPrivilege([] {
    const rlimit none{0, 0};
    setrlimit(RLIMIT_MEMLOCK, &none);
    return lockMemory().refused == 0 ? 1 : 0;
  });
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "the sanitizers take mlockall away, code " << code;
#endif
  EXPECT_EQ(code, 0);
}

TEST(LockMemory, UnderALimitDoesNotClaimWhatIsMappedLater) {
  const int code = withoutPrivilege([] {
    rlimit limit{};
    getrlimit(RLIMIT_MEMLOCK, &limit);
    constexpr rlim_t kMuch = rlim_t{1} << 30;
    limit.rlim_cur = limit.rlim_max = limit.rlim_max < kMuch ? limit.rlim_max : kMuch;
    if (setrlimit(RLIMIT_MEMLOCK, &limit) != 0) return 2;
    const MemoryLock lock = lockMemory();
    if (lock.future) return 1;
    return lock.present == (lock.refused == 0) ? 0 : 3;
  });
  EXPECT_EQ(code, 0);
}

TEST(ThreadStacks, AreOfOneMiBOnceShortened) {
#if defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "ThreadSanitizer has most of a stack of 1 MiB for itself";
#endif
  pthread_attr_t usual;
  ASSERT_EQ(pthread_getattr_default_np(&usual), 0);
  shortenThreadStacks();
  std::size_t bytes = 0;
  Thread thread({"test-stack"}, [&] {
    pthread_attr_t attributes;
    if (pthread_getattr_np(pthread_self(), &attributes) != 0) return;
    pthread_attr_getstacksize(&attributes, &bytes);
    pthread_attr_destroy(&attributes);
  });
  thread.join();
  pthread_setattr_default_np(&usual);
  pthread_attr_destroy(&usual);
  EXPECT_EQ(bytes, std::size_t{1024} * 1024);
}

TEST(LockMemory, LeavesLargePiecesOfMemoryApart) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "the sanitizers have a malloc of their own";
#endif
  const int code = withoutPrivilege([] {
    (void)lockMemory();
    constexpr std::size_t kMiB = std::size_t{1} << 20;
    const std::size_t before = mallinfo2().hblkhd;
    void* volatile model = std::malloc(8 * kMiB);
    void* volatile buffer = std::malloc(kMiB + 4096);  // as large as one of DDS
    const std::size_t apart = mallinfo2().hblkhd - before;
    std::free(model);
    std::free(buffer);
    if (apart < 8 * kMiB || apart >= 9 * kMiB) return 1;
    return mallinfo2().hblkhd == before ? 0 : 2;
  });
  EXPECT_EQ(code, 0);
}

TEST(CpuLatencyHold, IsHeldOrMissingButNeverFatal) {
  const bool may = access("/dev/cpu_dma_latency", W_OK) == 0;
  const CpuLatencyHold hold;
  EXPECT_EQ(hold.held(), may);
}

}  // namespace
}  // namespace palpate::rt
