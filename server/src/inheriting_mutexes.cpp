// SPDX-License-Identifier: Apache-2.0
// Cyclone DDS makes its mutexes without attributes, and force-out takes some that ordinary threads of the process hold now and
// then. Such a thread can lose its processor meanwhile, and force-out would wait for it. In palpate-server every mutex that is
// made without attributes passes on the priority of whoever waits for it (docs/decisions/shared_locks.md). Not a source of the
// server's parts: it is for the process as a whole.
#include <pthread.h>

#include "libcs_function.h"

// In the place of libc's, for libraries too: what an executable defines goes first.
extern "C" int pthread_mutex_init(pthread_mutex_t* mutex, const pthread_mutexattr_t* attributes) noexcept {
  using MutexInit = int(pthread_mutex_t*, const pthread_mutexattr_t*);
  static auto* const init = palpate::server::libcsFunction<MutexInit>("pthread_mutex_init");
  if (attributes != nullptr) return init(mutex, attributes);
  pthread_mutexattr_t passes_on;
  pthread_mutexattr_init(&passes_on);
  pthread_mutexattr_setprotocol(&passes_on, PTHREAD_PRIO_INHERIT);
  const int result = init(mutex, &passes_on);
  pthread_mutexattr_destroy(&passes_on);
  return result == 0 ? 0 : init(mutex, nullptr);  // a kernel without them
}
