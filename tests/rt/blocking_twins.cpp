// SPDX-License-Identifier: Apache-2.0
// Never linked. The compiler must report each mistake but kNone (-Wfunction-effects, preset rtsan). A macro of the
// mistake's name selects one.
#include <cstdlib>
#include <ctime>
#include <mutex>

#include "palpate/rt/periodic_thread.h"

namespace palpate::rt {

std::mutex mutex;

std::int64_t cycle(void*, const Cycle&) noexcept PALPATE_NONBLOCKING {
#if defined(kAllocates)
  std::free(std::malloc(100));
#elif defined(kLocks)
  mutex.lock();
#elif defined(kSleeps)
  const timespec pause{0, 1000};
  nanosleep(&pause, nullptr);
#endif
  return 0;
}

#if defined(kCycleThatMayBlock)
std::int64_t mayBlock(void*, const Cycle&) noexcept;
PeriodicThread::Function chosen = mayBlock;
#else
PeriodicThread::Function chosen = cycle;
#endif

}  // namespace palpate::rt
