// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

namespace palpate::rt {

/// A thread of this process as the kernel knows it; libraries make threads too.
struct ThreadFacts {
  int id{0};
  std::string name;       ///< at most 15 characters
  int fifo_priority{0};   ///< SCHED_FIFO, in [1, 99]; 0: an ordinary thread
  std::vector<int> cpus;  ///< where it may run, ascending
};

/// All threads of this process, oldest first. A thread that ends meanwhile is left out.
/// Real-time: no (reads /proc).
[[nodiscard]] std::vector<ThreadFacts> threadsOfThisProcess();

/// CPUs that the calling thread may use, ascending. Real-time: no.
[[nodiscard]] std::vector<int> usableCpus();

/// Restricts the calling thread, and each thread that it makes from now on, to these CPUs.
/// @return 0, or the errno of the refusal (EINVAL: none of them exists). Real-time: no.
[[nodiscard]] int useCpus(std::span<const int> cpus) noexcept;

/// "0-3,6"
[[nodiscard]] std::string cpuList(std::span<const int> cpus);

}  // namespace palpate::rt
