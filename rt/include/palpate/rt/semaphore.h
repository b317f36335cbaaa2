// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <semaphore.h>

#include <cerrno>
#include <cstdint>

#include "palpate/rt/clock.h"

namespace palpate::rt {

/// Wakes another thread. POSIX, because std::counting_semaphore of libstdc++ 12 may spin before it sleeps.
/// post() takes no lock and is async-signal-safe; it makes a system call only when a thread waits.
/// Threads: any number on both sides. Real-time: post() yes, wait() is where a thread gives up its core.
class Semaphore {
 public:
  Semaphore() noexcept { sem_init(&handle_, 0, 0); }
  ~Semaphore() { sem_destroy(&handle_); }
  Semaphore(const Semaphore&) = delete;
  Semaphore& operator=(const Semaphore&) = delete;

  // Trusted: both change a counter without a lock. When a thread waits, sem_post() makes one system call, FUTEX_WAKE,
  // which does not wait. POSIX lists it among the few functions that a signal handler may call.
  PALPATE_TRUSTED_BEGIN
  void post() noexcept PALPATE_NONBLOCKING { sem_post(&handle_); }

  /// @return false when there was nothing to take
  [[nodiscard]] bool tryWait() noexcept PALPATE_NONBLOCKING { return sem_trywait(&handle_) == 0; }
  PALPATE_TRUSTED_END

  void wait() noexcept {
    while (sem_wait(&handle_) != 0 && errno == EINTR) {
    }
  }

  /// @param[in] timeout_ns  longest wait from now, ns
  /// @return false when the time passed without a post
  [[nodiscard]] bool waitFor(std::int64_t timeout_ns) noexcept {
    const timespec until = toTimespec(monotonicNow() + timeout_ns);
    int result = 0;
    do {
      result = sem_clockwait(&handle_, CLOCK_MONOTONIC, &until);
    } while (result != 0 && errno == EINTR);
    return result == 0;
  }

 private:
  sem_t handle_{};
};

}  // namespace palpate::rt
