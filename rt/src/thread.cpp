// SPDX-License-Identifier: Apache-2.0
#include "palpate/rt/thread.h"

#include <pthread.h>

#include <cstring>
#include <future>
#include <utility>

#include "palpate/rt/memory.h"
#include "palpate/rt/process_threads.h"

namespace palpate::rt {
namespace {

/// Name, CPUs, priority and stack of the calling thread.
/// @return 0, the errno that refused the priority, or less the errno that refused the CPUs
int settle(const ThreadOptions& options) {
  pthread_setname_np(pthread_self(), options.name.substr(0, 15).c_str());
  if (!options.cpus.empty()) {
    if (const int error = useCpus(options.cpus); error != 0) return -error;
  }
  prefaultStack();
  const bool wanted = options.priority > 0 && options.policy != RealtimePolicy::kOff;
  return wanted ? raiseThisThread(options.priority) : 0;
}

}  // namespace

Thread::Thread(const ThreadOptions& options, std::function<void()> body) {
  std::promise<int> settled;
  std::promise<void> ended;
  ended_ = ended.get_future();
  std::future<int> refusal = settled.get_future();
  const bool required = options.priority > 0 && options.policy == RealtimePolicy::kRequire;
  thread_ = std::thread([options, required, settled = std::move(settled), ended = std::move(ended),
                         body = std::move(body)]() mutable {
    const int error = settle(options);
    settled.set_value(error);
    if (error == 0 || (error > 0 && !required)) body();
    ended.set_value_at_thread_exit();
  });
  const int error = refusal.get();
  realtime_ = error == 0 && options.priority > 0 && options.policy != RealtimePolicy::kOff;
  if (error == 0 || (error > 0 && !required)) return;
  join();
  if (error < 0)
    throw RealtimeError("thread " + options.name + ": CPUs " + cpuList(options.cpus) + " refused (" +
                        std::strerror(-error) + ")");
  throw RealtimeError("thread " + options.name + ": SCHED_FIFO priority " + std::to_string(options.priority) +
                      " refused (" + std::strerror(error) + "); grant CAP_SYS_NICE or raise RLIMIT_RTPRIO");
}

void Thread::join() {
  if (thread_.joinable()) thread_.join();
}

bool Thread::joinWithin(std::chrono::milliseconds patience) {
  const std::future_status status = ended_.wait_for(patience);
  if (status == std::future_status::ready) join();
  return status == std::future_status::ready;
}

}  // namespace palpate::rt
