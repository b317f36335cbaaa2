// SPDX-License-Identifier: Apache-2.0
// Whoever maps or unmaps holds the lock of the address space meanwhile, with locked memory for as long as its pages take to come. The thread
// that loads models gives way to all others: on a busy machine it stood for a second with that lock, behind it ordinary threads
// that grew malloc's heap and held malloc's locks, and behind those force-out. In palpate-server a thread that maps or unmaps has a
// real-time priority for so long, the lowest (docs/decisions/shared_locks.md). Not a source of the server's parts: it is for the process as
// a whole.
#include <dlfcn.h>
#include <sched.h>
#include <sys/mman.h>

#include <cstddef>
#include <cstring>

namespace palpate::server {
namespace {

using Map = void*(void*, std::size_t, int, int, int, off_t);
using Unmap = int(void*, std::size_t);

template <class Function>
Function* libcs(const char* name) noexcept {
  void* const found = dlsym(RTLD_NEXT, name);
  Function* function = nullptr;
  static_assert(sizeof found == sizeof function);
  std::memcpy(&function, &found, sizeof found);
  return function;
}

// Where no real-time priority is granted the thread keeps its own. Its niceness outlives the change.
class Urgent {
 public:
  Urgent() noexcept {
    sched_param lowest{};
    lowest.sched_priority = 1;
    raised_ = sched_getscheduler(0) == SCHED_OTHER && sched_setscheduler(0, SCHED_FIFO, &lowest) == 0;
  }
  ~Urgent() {
    const sched_param none{};
    if (raised_) sched_setscheduler(0, SCHED_OTHER, &none);
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
  static auto* const next = palpate::server::libcs<palpate::server::Map>("mmap");
  const palpate::server::Urgent urgent;
  return next(address, bytes, protection, flags, file, offset);
}

extern "C" int munmap(void* address, std::size_t bytes) noexcept {
  static auto* const next = palpate::server::libcs<palpate::server::Unmap>("munmap");
  const palpate::server::Urgent urgent;
  return next(address, bytes);
}
