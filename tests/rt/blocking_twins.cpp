// SPDX-License-Identifier: Apache-2.0
// Never linked: each mistake but kNone is one that the compiler has to name by itself (-Wfunction-effects, preset
// rtsan). One at a time, chosen by a macro of that name.
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
