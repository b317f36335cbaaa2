// SPDX-License-Identifier: Apache-2.0
// The wrong twin of a tick, to show that what counts its calls can find something. Loaded into palpate-server before the
// counter: from time to time, where a tick wakes the thread that sends forces, it does what no tick may do.
// Or the thread that sends fields spins, or hangs.
#include <dlfcn.h>
#include <pthread.h>
#include <sched.h>
#include <semaphore.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cstdlib>
#include <cstring>
#include <ctime>
#include <string_view>

#include "tick_counts.h"

namespace palpate::proof {
namespace {

constexpr int kSeldom = 200;  // posts to a mistake
constexpr std::size_t kPage = 4096;

using Post = int(sem_t*);
using Wait = int(sem_t*, clockid_t, const timespec*);

Post* next_post = nullptr;
Wait* next_wait = nullptr;
std::string_view mistake;
pthread_mutex_t mutex = PTHREAD_MUTEX_INITIALIZER;
__attribute__((tls_model("initial-exec"))) thread_local int posts = 0;
__attribute__((tls_model("initial-exec"))) thread_local int is_tick = -1;

void allocate() noexcept {
  void* volatile memory = std::malloc(100);
  std::free(memory);
}

void lock() noexcept {
  pthread_mutex_lock(&mutex);
  pthread_mutex_unlock(&mutex);
}

// A page that nobody has touched. What is mapped now would be locked, and so be there at once.
void touchFreshPage() noexcept {
  void* const page = mmap(nullptr, kPage, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (page == MAP_FAILED) return;
  munlock(page, kPage);
  madvise(page, kPage, MADV_DONTNEED);
  *static_cast<volatile char*>(page) = 1;
  munmap(page, kPage);
}

void sleep() noexcept {
  const timespec pause{0, 20'000};
  nanosleep(&pause, nullptr);
}

void makeMistake() noexcept {
  if (mistake == "malloc") allocate();
  if (mistake == "lock") lock();
  if (mistake == "fault") touchFreshPage();
  if (mistake == "sleep") sleep();
  for (volatile bool spins = mistake == "spin"; spins;) {
  }
}

// Computes as long as this thread has a real-time priority, once.
void spinWhileRaised() noexcept {
  static bool spun = false;
  while (!spun && sched_getscheduler(0) == SCHED_FIFO) {
  }
  spun = true;
}

void hang() noexcept {
  for (;;) pause();
}

bool isThread(std::string_view name) noexcept {
  char own[16] = {};
  pthread_getname_np(pthread_self(), own, sizeof own);
  return own == name;
}

// Before main().
__attribute__((constructor)) void prepare() noexcept {
  void* found = dlsym(RTLD_NEXT, "sem_post");
  std::memcpy(&next_post, &found, sizeof found);
  found = dlsym(RTLD_NEXT, "sem_clockwait");
  std::memcpy(&next_wait, &found, sizeof found);
  if (const char* const wanted = std::getenv(kMistakeVariable)) mistake = wanted;
}

}  // namespace
}  // namespace palpate::proof

extern "C" int sem_post(sem_t* semaphore) noexcept {
  using namespace palpate::proof;
  if (is_tick < 0) is_tick = isThread(kTickThread) ? 1 : 0;
  if (is_tick == 1 && ++posts % kSeldom == 0) makeMistake();
  if (next_post == nullptr) prepare();
  return next_post(semaphore);
}

extern "C" int sem_clockwait(sem_t* semaphore, clockid_t clock, const timespec* until) noexcept {
  using namespace palpate::proof;
  if (next_wait == nullptr) prepare();
  if (mistake == "spin surface-out" && isThread("surface-out")) spinWhileRaised();
  if (mistake == "hang surface-out" && isThread("surface-out")) hang();
  return next_wait(semaphore, clock, until);
}
