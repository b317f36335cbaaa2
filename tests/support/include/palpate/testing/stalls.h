// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <mutex>
#include <span>
#include <thread>
#include <vector>

namespace palpate::testing {

/// How long work had to wait for a processor: a thread on each, which sleeps for a while and looks how late it woke.
class Stalls {
 public:
  /// @param[in] cpus      their numbers
  /// @param[in] priority  SCHED_FIFO priority of the work, in [1, 99]; 0: ordinary work. Where this process may not have that priority,
  ///                      nothing is seen
  explicit Stalls(std::span<const int> cpus, int priority = 0);
  ~Stalls();
  Stalls(const Stalls&) = delete;
  Stalls& operator=(const Stalls&) = delete;

  /// Lateness between two times of CLOCK_MONOTONIC, summed, on the processor that had most of it; ms.
  [[nodiscard]] double between(std::int64_t from_ns, std::int64_t until_ns) const;
  /// The longest lateness between two such times, on any processor, ms. One that goes on is not seen yet.
  [[nodiscard]] double longest(std::int64_t from_ns, std::int64_t until_ns) const;

 private:
  struct Late {
    std::size_t cpu;  // its place among those that are watched
    std::int64_t due_ns;
    std::int64_t woke_ns;
  };

  [[nodiscard]] static std::int64_t within(const Late& late, std::int64_t from_ns, std::int64_t until_ns);
  void watch(std::size_t cpu, int number, int priority);

  mutable std::mutex mutex_;
  std::vector<Late> late_;
  std::atomic<bool> stopping_{false};
  std::vector<std::thread> threads_;  // last: they use the other members
};

}  // namespace palpate::testing
