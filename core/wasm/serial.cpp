// SPDX-License-Identifier: Apache-2.0
// core/base/parallel.h without threads: a page's worker is one.
#include "core/base/parallel.h"

namespace palpate {

int loadThreads() noexcept {
  return 1;
}

void parallelFor(int, std::size_t chunks, const std::function<void(int, std::size_t)>& work) {
  for (std::size_t chunk = 0; chunk < chunks; ++chunk) work(0, chunk);
}

}  // namespace palpate
