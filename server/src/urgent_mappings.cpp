// SPDX-License-Identifier: Apache-2.0
// A thread that maps, unmaps or locks memory holds the lock of the address space meanwhile, for as long as the pages
// take to come. The thread that loads models gives way to all others: on a busy machine it stood for a second with
// that lock, behind it ordinary threads that grew malloc's heaps and held malloc's locks, and behind those force-out.
// In palpate-server an ordinary thread has a real-time priority for so long, the lowest (docs/decisions/shared_locks.md).
// Not a source of the server's parts: it is for the process as a whole.
#include "palpate/server/urgent_mappings.h"

#include <sched.h>
#include <sys/mman.h>

#include <cerrno>
#include <cstddef>
#include <ctime>

#include "libcs_function.h"

namespace palpate::server {
namespace {

// Less takes no time. More would be told of as a thread that spins (docs/decisions/spinning.md).
constexpr std::size_t kLeast = std::size_t{64} * 1024;
constexpr std::size_t kMostBytes = std::size_t{64} * 1024 * 1024;

bool isRaised() noexcept {
  sched_param has{};
  return sched_getscheduler(0) == SCHED_FIFO && sched_getparam(0, &has) == 0 &&
         has.sched_priority == kMappingPriority;
}

// Where no real-time priority is granted the thread keeps its own. Its niceness outlives the change, and so does errno.
class Urgent {
 public:
  explicit Urgent(std::size_t bytes) noexcept {
    if (bytes < kLeast || bytes > kMostBytes || !urgent_mappings.load(std::memory_order_relaxed)) return;
    const int error = errno;
    sched_param lowest{};
    lowest.sched_priority = kMappingPriority;
    raised_ = sched_getscheduler(0) == SCHED_OTHER && sched_setscheduler(0, SCHED_FIFO, &lowest) == 0;
    errno = error;
  }
  ~Urgent() {
    if (!raised_ || !isRaised()) return;  // others may have raised it for good
    // The kernel adds up what a thread computes at such a priority until it has slept at it (RLIMIT_RTTIME).
    constexpr timespec kBriefly{0, 20'000};
    clock_nanosleep(CLOCK_MONOTONIC, 0, &kBriefly, nullptr);
    const sched_param none{};
    sched_setscheduler(0, SCHED_OTHER, &none);
  }
  Urgent(const Urgent&) = delete;
  Urgent& operator=(const Urgent&) = delete;

 private:
  bool raised_{false};
};

}  // namespace
}  // namespace palpate::server

// In the place of libc's, for libraries too: what an executable defines goes first. malloc has ways of its own.
extern "C" void* mmap(void* address, std::size_t bytes, int protection, int flags, int file,
                      off_t offset) noexcept {
  using Map = void*(void*, std::size_t, int, int, int, off_t);
  static auto* const next = palpate::server::libcsFunction<Map>("mmap");
  const palpate::server::Urgent urgent(bytes);
  return next(address, bytes, protection, flags, file, offset);
}

extern "C" int munmap(void* address, std::size_t bytes) noexcept {
  using Unmap = int(void*, std::size_t);
  static auto* const next = palpate::server::libcsFunction<Unmap>("munmap");
  const palpate::server::Urgent urgent(bytes);
  return next(address, bytes);
}

extern "C" int mlock(const void* address, std::size_t bytes) noexcept {
  using Lock = int(const void*, std::size_t);
  static auto* const next = palpate::server::libcsFunction<Lock>("mlock");
  const palpate::server::Urgent urgent(bytes);
  return next(address, bytes);
}
