// SPDX-License-Identifier: Apache-2.0
// Loaded before all other libraries of palpate-server (LD_PRELOAD): makes ticks late, for a cause that is known. It begins at
// SIGUSR2, acts where a tick wakes the thread that sends forces, and pauses after kInjections.
#include <dlfcn.h>
#include <fcntl.h>
#include <pthread.h>
#include <semaphore.h>
#include <sys/mman.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <string_view>

#include "late_injections.h"

namespace palpate::proof {
namespace {

constexpr int kSeldom = 40;                // ticks from one injection to the next
constexpr std::int64_t kLong = 5'000'000;  // ns that a tick is late
constexpr std::size_t kPage = 4096;
constexpr std::size_t kPages = 4000;

using GetTime = int(clockid_t, timespec*);
using Sleep = int(clockid_t, int, const timespec*, timespec*);
using Post = int(sem_t*);
using WaitUntil = int(sem_t*, clockid_t, const timespec*);

GetTime* next_get_time = nullptr;
Sleep* next_sleep = nullptr;
Post* next_post = nullptr;
WaitUntil* next_wait_until = nullptr;

std::string_view cause;
std::atomic<int> left{0};               // injections to come
std::atomic<std::int64_t> leapt_ns{0};  // CLOCK_MONOTONIC, as all threads of the server see it
std::atomic<std::int64_t> wall_ns{0};   // CLOCK_REALTIME
__attribute__((tls_model("initial-exec"))) thread_local int is_tick = -1;
__attribute__((tls_model("initial-exec"))) thread_local int ticks = 0;

template <class Function>
void find(const char* name, Function*& next) noexcept {
  void* const found = dlsym(RTLD_NEXT, name);
  static_assert(sizeof found == sizeof next);
  std::memcpy(&next, &found, sizeof found);
}

void onBegin(int) {
  left.store(kInjections);
}

// Before main().
__attribute__((constructor)) void prepare() noexcept {
  find("clock_gettime", next_get_time);
  find("clock_nanosleep", next_sleep);
  find("sem_post", next_post);
  find("sem_clockwait", next_wait_until);
  if (const char* const wanted = std::getenv(kLateCauseVariable)) cause = wanted;
  std::signal(SIGUSR2, onBegin);
}

timespec shifted(const timespec& time, std::int64_t by_ns) noexcept {
  const std::int64_t ns = static_cast<std::int64_t>(time.tv_sec) * 1'000'000'000 + time.tv_nsec + by_ns;
  return {static_cast<time_t>(ns / 1'000'000'000), static_cast<long>(ns % 1'000'000'000)};
}

std::int64_t cpuTime() noexcept {
  timespec now{};
  next_get_time(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<std::int64_t>(now.tv_sec) * 1'000'000'000 + now.tv_nsec;
}

void work() noexcept {
  for (const std::int64_t end = cpuTime() + kLong; cpuTime() < end;) {
  }
}

// Pages that nobody has touched. What is mapped now would be locked, and so be there at once.
void touchFreshPages() noexcept {
  void* const pages = mmap(nullptr, kPages * kPage, PROT_READ | PROT_WRITE,
                           MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (pages == MAP_FAILED) return;
  munlock(pages, kPages * kPage);
  madvise(pages, kPages * kPage, MADV_NOHUGEPAGE);
  madvise(pages, kPages * kPage, MADV_DONTNEED);
  for (std::size_t i = 0; i < kPages; ++i) static_cast<volatile char*>(pages)[i * kPage] = 1;
  munmap(pages, kPages * kPage);
}

std::int64_t now() noexcept {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);  // as the server sees it
  return static_cast<std::int64_t>(now.tv_sec) * 1'000'000'000 + now.tv_nsec;
}

// Pages of a file that were put out of memory: each is waited for.
// @return the time that this took, ns. A page that takes eight times as long as those before it, and over a millisecond,
// waits for a machine that stands still.
std::int64_t readFromDisk() noexcept {
  const char* const name = std::getenv(kLateFileVariable);
  const int file = open(name == nullptr ? "" : name, O_RDONLY | O_CLOEXEC);
  if (file < 0) return 0;
  posix_fadvise(file, 0, 0, POSIX_FADV_DONTNEED);
  const void* const pages =
      mmap(nullptr, kPages * kPage, PROT_NONE, MAP_PRIVATE | MAP_NORESERVE, file, 0);  // none to lock
  if (pages == MAP_FAILED) return 0;
  void* const bytes = const_cast<void*>(pages);
  munlock(bytes, kPages * kPage);
  mprotect(bytes, kPages * kPage, PROT_READ);
  madvise(bytes, kPages * kPage, MADV_RANDOM);  // one at a time
  std::int64_t spent = 0, before = now();
  for (std::size_t i = 0; i < kPages && spent < kLong; ++i) {
    static_cast<void>(static_cast<const volatile char*>(pages)[(i * 37 % kPages) * kPage]);
    const std::int64_t after = now(), took = after - before;
    const std::int64_t usual = i == 0 ? took : 8 * spent / static_cast<std::int64_t>(i);
    const std::int64_t longest = usual < 1'000'000 ? 1'000'000 : usual;
    spent += took < longest ? took : longest;
    before = after;
  }
  munmap(bytes, kPages * kPage);
  close(file);
  return spent;
}

// In the server's log: when, and for how long.
void tell(std::int64_t at_ns, std::int64_t for_ns) noexcept {
  char line[80];
  const int length = std::snprintf(line, sizeof line, kInjectedLine, static_cast<long long>(at_ns / 1000),
                                   static_cast<long long>(for_ns / 1000));
  [[maybe_unused]] const ssize_t written = write(STDERR_FILENO, line, static_cast<std::size_t>(length));
}

void inject() noexcept {
  const std::int64_t at_ns = now(), ran_ns = cpuTime();
  std::int64_t read_ns = 0;
  if (cause == kWork) work();
  if (cause == kFault) touchFreshPages();
  if (cause == kRead) read_ns = readFromDisk();
  if (cause == kLeap) leapt_ns.fetch_add(kLong);
  if (cause == kWall) {
    wall_ns.store(2'000'000'000);
    work();
  }
  if (cause == kRead) return tell(at_ns, read_ns);
  tell(at_ns, cause == kLeap ? now() - at_ns : cpuTime() - ran_ns);
}

bool isTickThread() noexcept {
  char name[16] = {};
  pthread_getname_np(pthread_self(), name, sizeof name);
  return std::string_view(name) == "tick";
}

}  // namespace
}  // namespace palpate::proof

extern "C" int sem_post(sem_t* semaphore) noexcept {
  using namespace palpate::proof;
  if (next_post == nullptr) prepare();
  if (is_tick < 0) is_tick = isTickThread() ? 1 : 0;
  if (is_tick == 1 && left.load() > 0 && ++ticks % kSeldom == 0) {
    inject();
    left.fetch_sub(1);
  }
  return next_post(semaphore);
}

extern "C" int clock_gettime(clockid_t clock, timespec* time) noexcept {
  using namespace palpate::proof;
  if (next_get_time == nullptr) prepare();
  const int result = next_get_time(clock, time);
  if (result == 0 && clock == CLOCK_MONOTONIC) *time = shifted(*time, leapt_ns.load());
  if (result == 0 && clock == CLOCK_REALTIME) *time = shifted(*time, wall_ns.load());
  return result;
}

extern "C" int clock_nanosleep(clockid_t clock, int flags, const timespec* time, timespec* left) {
  using namespace palpate::proof;
  if (next_sleep == nullptr) prepare();
  const bool until = clock == CLOCK_MONOTONIC && (flags & TIMER_ABSTIME) != 0;
  const timespec real = shifted(*time, until ? -leapt_ns.load() : 0);
  return next_sleep(clock, flags, &real, left);
}

extern "C" int sem_clockwait(sem_t* semaphore, clockid_t clock, const timespec* time) {
  using namespace palpate::proof;
  if (next_wait_until == nullptr) prepare();
  const timespec real = shifted(*time, clock == CLOCK_MONOTONIC ? -leapt_ns.load() : 0);
  return next_wait_until(semaphore, clock, &real);
}
