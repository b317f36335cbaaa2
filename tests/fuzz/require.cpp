// SPDX-License-Identifier: Apache-2.0
#include <ctime>
#include <stdexcept>

#include "targets.h"

namespace palpate::fuzz {

namespace {

// Of this thread: OpenBLAS has others, which wait busily when a program begins.
double processorTime() {
  timespec time{};
  (void)clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

}  // namespace

bool soonEnough(bool (*read)(Bytes), Bytes input, double most) {
  const double began = processorTime();
  const bool taken = read(input);
  require(processorTime() - began <= most, "an input takes too much of the processor");
  return taken;
}

void require(bool good, const char* what) {
  if (!good) throw std::logic_error(what);
}

}  // namespace palpate::fuzz
