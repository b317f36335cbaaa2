// SPDX-License-Identifier: Apache-2.0
#include "tools/solver/base/parallel.h"

#include <cblas.h>

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace palpate::solver {

SerialBlas::SerialBlas() : threads_(openblas_get_num_threads()) {
  openblas_set_num_threads(1);
}

SerialBlas::~SerialBlas() {
  openblas_set_num_threads(threads_);
}

int machineThreads() {
  return static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
}

std::string blasVersion() {
  return openblas_get_config();
}

void parallelFor(int workers, std::size_t chunks, const std::function<void(int, std::size_t)>& work) {
  const SerialBlas serial;
  std::atomic<std::size_t> next{0};
  std::exception_ptr failure;
  std::mutex failure_mutex;
  const auto run = [&](int worker) {
    try {
      for (std::size_t chunk = next++; chunk < chunks; chunk = next++) work(worker, chunk);
    } catch (...) {
      const std::lock_guard lock(failure_mutex);
      if (!failure) failure = std::current_exception();
      next = chunks;
    }
  };
  {
    std::vector<std::jthread> threads;
    for (int worker = 1; worker < workers; ++worker) threads.emplace_back(run, worker);
    run(0);
  }
  if (failure) std::rethrow_exception(failure);
}

}  // namespace palpate::solver
