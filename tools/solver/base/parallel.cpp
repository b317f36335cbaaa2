// SPDX-License-Identifier: Apache-2.0
#include "tools/solver/base/parallel.h"

#include <cblas.h>

#include <algorithm>
#include <thread>

#include "core/base/parallel.h"

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
  palpate::parallelFor(workers, chunks, work);
}

}  // namespace palpate::solver
