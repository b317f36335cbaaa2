// SPDX-License-Identifier: Apache-2.0
// Loaded before all other libraries of palpate-server (LD_PRELOAD): counts what its tick thread calls, and asks the
// kernel for its page faults and context switches. Everything is passed on. What an executable or library reaches
// without the dynamic linker (libc's own calls within itself, a bare system call) is not seen here; if it waits, the
// kernel's count of voluntary switches shows it.
#include <dlfcn.h>
#include <poll.h>
#include <pthread.h>
#include <semaphore.h>
#include <sys/epoll.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/select.h>
#include <sys/socket.h>
#include <sys/uio.h>
#include <unistd.h>

#include <cstdlib>
#include <cstring>
#include <ctime>
#include <string_view>

#include "tick_counts.h"

// glibc's own entry points; the public names are ours.
extern "C" {
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* memory, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);
void __libc_free(void* memory);
}

namespace palpate::proof {
namespace {

enum class Role { kUnknown, kTick, kOther };

TickCounts* counts = nullptr;  // set before main()

// In the block that every thread is born with: looking at them never allocates.
__attribute__((tls_model("initial-exec"))) thread_local Role role = Role::kUnknown;
__attribute__((tls_model("initial-exec"))) thread_local bool counting = false;
__attribute__((tls_model("initial-exec"))) thread_local Usage at_begin;

void note(Kind kind) noexcept {
  if (counting) ++counts->calls[static_cast<std::size_t>(kind)];
}

void notePost(const sem_t* semaphore) noexcept {
  if (!counting) return;
  const auto address = reinterpret_cast<std::uintptr_t>(semaphore);
  for (Posts& posts : counts->posts) {
    if (posts.semaphore == 0) posts.semaphore = address;
    if (posts.semaphore != address) continue;
    ++posts.count;
    return;
  }
  ++counts->other_posts;
}

Usage usageOfThisThread() noexcept {
  rusage usage{};
  getrusage(RUSAGE_THREAD, &usage);
  return {usage.ru_minflt, usage.ru_majflt, usage.ru_nvcsw, usage.ru_nivcsw};
}

Role roleOfThisThread() noexcept {
  char name[16] = {};
  pthread_getname_np(pthread_self(), name, sizeof name);
  return counts != nullptr && std::string_view(name) == kTickThread ? Role::kTick : Role::kOther;
}

void begin() noexcept {
  at_begin = usageOfThisThread();
  counts->state.store(TickCounts::kCounting, std::memory_order_relaxed);
  counting = true;
}

void end() noexcept {
  counting = false;
  const Usage now = usageOfThisThread();
  counts->usage = {now.minor_faults - at_begin.minor_faults, now.major_faults - at_begin.major_faults,
                   now.voluntary - at_begin.voluntary, now.involuntary - at_begin.involuntary};
  counts->state.store(TickCounts::kDone, std::memory_order_release);  // SYNC DONE
}

// A tick's end: the tick thread is about to sleep. What is counted begins and ends here, so that each sleep that is
// counted has its tick behind it.
void onTickSleeps() noexcept {
  if (role == Role::kUnknown) role = roleOfThisThread();
  if (role != Role::kTick) return;
  const std::uint32_t command = counts->command.load(std::memory_order_relaxed);
  if (!counting && command == TickCounts::kCount) begin();
  if (counting && command == TickCounts::kStop) end();
  if (counting) ++counts->sleeps;
}

template <class Function>
Function* next(const char* name) noexcept {
  void* const found = dlsym(RTLD_NEXT, name);
  Function* function = nullptr;
  static_assert(sizeof found == sizeof function);
  std::memcpy(&function, &found, sizeof found);
  return function;
}

}  // namespace
}  // namespace palpate::proof

// A function of glibc as it is, counted. Looked up on its first call, or before main(): never in a tick.
#define PALPATE_COUNTED(kind, result, name, qualifier, parameters, arguments)                 \
  static result(*next_##name) parameters = nullptr;                                           \
  extern "C" result name parameters qualifier {                                               \
    if (next_##name == nullptr) next_##name = palpate::proof::next<result parameters>(#name); \
    palpate::proof::note(palpate::proof::Kind::kind);                                         \
    return next_##name arguments;                                                             \
  }

PALPATE_COUNTED(kLock, int, pthread_mutex_lock, noexcept, (pthread_mutex_t * m), (m))
PALPATE_COUNTED(kLock, int, pthread_mutex_trylock, noexcept, (pthread_mutex_t * m), (m))
PALPATE_COUNTED(kLock, int, pthread_mutex_timedlock, noexcept, (pthread_mutex_t * m, const timespec* t),
                (m, t))
PALPATE_COUNTED(kLock, int, pthread_mutex_clocklock, noexcept,
                (pthread_mutex_t * m, clockid_t c, const timespec* t), (m, c, t))
PALPATE_COUNTED(kLock, int, pthread_rwlock_rdlock, noexcept, (pthread_rwlock_t * l), (l))
PALPATE_COUNTED(kLock, int, pthread_rwlock_wrlock, noexcept, (pthread_rwlock_t * l), (l))
PALPATE_COUNTED(kLock, int, pthread_spin_lock, noexcept, (pthread_spinlock_t * l), (l))
PALPATE_COUNTED(kWait, int, sem_wait, , (sem_t * s), (s))
PALPATE_COUNTED(kWait, int, sem_timedwait, , (sem_t * s, const timespec* t), (s, t))
PALPATE_COUNTED(kWait, int, sem_clockwait, , (sem_t * s, clockid_t c, const timespec* t), (s, c, t))
PALPATE_COUNTED(kWait, int, nanosleep, , (const timespec* t, timespec* left), (t, left))
PALPATE_COUNTED(kWait, int, usleep, , (useconds_t t), (t))
PALPATE_COUNTED(kWait, int, sched_yield, noexcept, (), ())
PALPATE_COUNTED(kWait, int, pthread_join, , (pthread_t t, void** r), (t, r))
PALPATE_COUNTED(kSystemCall, ssize_t, read, , (int f, void* p, size_t n), (f, p, n))
PALPATE_COUNTED(kSystemCall, ssize_t, write, , (int f, const void* p, size_t n), (f, p, n))
PALPATE_COUNTED(kSystemCall, ssize_t, writev, , (int f, const iovec* v, int n), (f, v, n))
PALPATE_COUNTED(kSystemCall, ssize_t, sendmsg, , (int f, const msghdr* m, int o), (f, m, o))
PALPATE_COUNTED(kSystemCall, ssize_t, recvmsg, , (int f, msghdr* m, int o), (f, m, o))
PALPATE_COUNTED(kSystemCall, int, poll, , (pollfd * f, nfds_t n, int t), (f, n, t))
PALPATE_COUNTED(kSystemCall, int, select, , (int n, fd_set* r, fd_set* w, fd_set* e, timeval* t),
                (n, r, w, e, t))
PALPATE_COUNTED(kSystemCall, int, epoll_wait, , (int d, epoll_event* e, int n, int t), (d, e, n, t))
PALPATE_COUNTED(kSystemCall, int, close, , (int f), (f))
PALPATE_COUNTED(kSystemCall, int, munmap, noexcept, (void* p, size_t n), (p, n))
PALPATE_COUNTED(kSystemCall, int, madvise, noexcept, (void* p, size_t n, int a), (p, n, a))
PALPATE_COUNTED(kSystemCall, void*, mmap, noexcept, (void* p, size_t n, int r, int f, int d, off_t o),
                (p, n, r, f, d, o))

static int (*next_sem_post)(sem_t*) = nullptr;
extern "C" int sem_post(sem_t* semaphore) noexcept {
  if (next_sem_post == nullptr) next_sem_post = palpate::proof::next<int(sem_t*)>("sem_post");
  palpate::proof::notePost(semaphore);
  return next_sem_post(semaphore);
}

static int (*next_clock_nanosleep)(clockid_t, int, const timespec*, timespec*) = nullptr;
extern "C" int clock_nanosleep(clockid_t clock, int flags, const timespec* time, timespec* left) {
  if (next_clock_nanosleep == nullptr)
    next_clock_nanosleep =
        palpate::proof::next<int(clockid_t, int, const timespec*, timespec*)>("clock_nanosleep");
  palpate::proof::onTickSleeps();
  return next_clock_nanosleep(clock, flags, time, left);
}

extern "C" void* malloc(std::size_t size) noexcept {
  palpate::proof::note(palpate::proof::Kind::kAllocation);
  return __libc_malloc(size);
}
extern "C" void* calloc(std::size_t count, std::size_t size) noexcept {
  palpate::proof::note(palpate::proof::Kind::kAllocation);
  return __libc_calloc(count, size);
}
extern "C" void* realloc(void* memory, std::size_t size) noexcept {
  palpate::proof::note(palpate::proof::Kind::kAllocation);
  return __libc_realloc(memory, size);
}
extern "C" void* aligned_alloc(std::size_t alignment, std::size_t size) noexcept {
  palpate::proof::note(palpate::proof::Kind::kAllocation);
  return __libc_memalign(alignment, size);
}
extern "C" int posix_memalign(void** memory, std::size_t alignment, std::size_t size) noexcept {
  palpate::proof::note(palpate::proof::Kind::kAllocation);
  *memory = __libc_memalign(alignment, size);
  return *memory == nullptr && size != 0 ? 12 : 0;  // ENOMEM
}
extern "C" void free(void* memory) noexcept {
  palpate::proof::note(palpate::proof::Kind::kFree);
  __libc_free(memory);
}

namespace palpate::proof {
namespace {

// Before main(): maps what the test shares, and looks up what a tick could be the first to call.
__attribute__((constructor)) void prepare() noexcept {
  next_pthread_mutex_lock = next<int(pthread_mutex_t*)>("pthread_mutex_lock");
  next_nanosleep = next<int(const timespec*, timespec*)>("nanosleep");
  next_sem_post = next<int(sem_t*)>("sem_post");
  next_clock_nanosleep = next<int(clockid_t, int, const timespec*, timespec*)>("clock_nanosleep");
  next_mmap = next<void*(void*, size_t, int, int, int, off_t)>("mmap");
  const char* const descriptor = std::getenv(kCountsVariable);
  if (descriptor == nullptr) return;
  void* const shared = next_mmap(nullptr, sizeof(TickCounts), PROT_READ | PROT_WRITE,
                                 MAP_SHARED | MAP_POPULATE, std::atoi(descriptor), 0);
  if (shared != MAP_FAILED) counts = static_cast<TickCounts*>(shared);
}

}  // namespace
}  // namespace palpate::proof
