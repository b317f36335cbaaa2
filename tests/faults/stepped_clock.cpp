// SPDX-License-Identifier: Apache-2.0
// Loaded before all other libraries of palpate-server (LD_PRELOAD): steps its wall clock, an hour forward by SIGUSR2 and back to the
// machine's by SIGUSR1, and says once that somebody has read it. Who waits for a time of that clock is woken by a step as the kernel's clock would
// wake it.
#include "stepped_clock.h"

#include <dlfcn.h>
#include <pthread.h>
#include <sys/syscall.h>
#include <sys/time.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <ctime>

namespace palpate::faults {
namespace {

using Wait = int(pthread_cond_t*, pthread_mutex_t*, const timespec*);

constexpr time_t kHour = 3600;
constexpr time_t kNoUptime =
    1'000'000'000;                  // s: a time as large is the wall clock's, not the monotonic one's
constexpr long kSlice = 5'000'000;  // ns, after which a waiter looks at the clock again

std::atomic<time_t> ahead{0};
std::atomic<bool> read_ahead{false};
Wait* next_wait = nullptr;

void onSignal(int signal) {
  ahead.store(signal == SIGUSR2 ? kHour : 0);
}

__attribute__((constructor)) void prepare() noexcept {
  // The condition variables since glibc 2.3.2; dlsym() may find those of before.
  void* const found = dlvsym(RTLD_NEXT, "pthread_cond_timedwait", "GLIBC_2.3.2");
  static_assert(sizeof found == sizeof next_wait);
  std::memcpy(&next_wait, &found, sizeof found);
  std::signal(SIGUSR1, onSignal);
  std::signal(SIGUSR2, onSignal);
}

timespec machineClock(clockid_t clock) noexcept {
  timespec now{};
  (void)syscall(SYS_clock_gettime, clock, &now);
  return now;
}

bool isBefore(const timespec& a, const timespec& b) noexcept {
  return a.tv_sec != b.tv_sec ? a.tv_sec < b.tv_sec : a.tv_nsec < b.tv_nsec;
}

}  // namespace
}  // namespace palpate::faults

extern "C" int clock_gettime(clockid_t clock, timespec* time) noexcept {
  using namespace palpate::faults;
  const long result = syscall(SYS_clock_gettime, clock, time);
  if (result != 0 || (clock != CLOCK_REALTIME && clock != CLOCK_REALTIME_COARSE))
    return static_cast<int>(result);
  time->tv_sec += ahead.load();
  if (ahead.load() != 0 && !read_ahead.exchange(true))
    (void)!write(STDERR_FILENO, kReadAhead, sizeof kReadAhead - 1);
  return static_cast<int>(result);
}

extern "C" int gettimeofday(timeval* time, void* /*zone*/) noexcept {
  timespec now{};
  (void)clock_gettime(CLOCK_REALTIME, &now);
  *time = {now.tv_sec, now.tv_nsec / 1000};
  return 0;
}

// Woken for nothing after each slice, as a condition variable's waiter may be.
extern "C" int pthread_cond_timedwait(pthread_cond_t* condition, pthread_mutex_t* mutex,
                                      const timespec* until) {
  using namespace palpate::faults;
  if (next_wait == nullptr) prepare();
  if (until->tv_sec < kNoUptime) return next_wait(condition, mutex, until);
  timespec due = *until, slice = machineClock(CLOCK_REALTIME);
  due.tv_sec -= ahead.load();
  slice.tv_nsec += kSlice;
  if (slice.tv_nsec >= 1'000'000'000) slice = {slice.tv_sec + 1, slice.tv_nsec - 1'000'000'000};
  const bool ends = isBefore(due, slice);
  const int result = next_wait(condition, mutex, ends ? &due : &slice);
  return result == ETIMEDOUT && !ends ? 0 : result;
}
