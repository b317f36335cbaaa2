// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <functional>
#include <future>
#include <string>
#include <thread>
#include <vector>

#include "palpate/rt/scheduling.h"

namespace palpate::rt {

/// How a thread is to run.
struct ThreadOptions {
  std::string name{"palpate"};                     ///< as in top and /proc, at most 15 characters
  int priority{0};                                 ///< SCHED_FIFO priority, in [1, 99]; 0: an ordinary thread
  RealtimePolicy policy{RealtimePolicy::kPrefer};  ///< what to do when the priority is refused
  std::vector<int> cpus{};                         ///< the CPUs that it may use; empty: those of its creator
};

/// A named thread with a priority, joined by its destructor.
class Thread {
 public:
  /// Starts the thread, touches its stack, and returns once its priority is granted or refused.
  /// @param[in] body  runs once on the new thread; must not throw
  /// @throw RealtimeError  the policy is kRequire and the system refuses, or it refuses the CPUs; body does not run then
  Thread(const ThreadOptions& options, std::function<void()> body);
  ~Thread() { join(); }
  Thread(const Thread&) = delete;
  Thread& operator=(const Thread&) = delete;

  void join();
  /// Joins a thread that ends within `patience`. @return whether it did; if not, it goes on, and the destructor waits for it
  [[nodiscard]] bool joinWithin(std::chrono::milliseconds patience);

  /// true when the thread runs under SCHED_FIFO
  [[nodiscard]] bool realtime() const noexcept { return realtime_; }

 private:
  bool realtime_{false};
  std::future<void> ended_;
  std::thread thread_;
};

}  // namespace palpate::rt
