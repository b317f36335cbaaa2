// SPDX-License-Identifier: Apache-2.0
#include "palpate/rt/memory.h"

#include <malloc.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstddef>

namespace palpate::rt {
namespace {

constexpr std::size_t kStackBytes = std::size_t{256} * 1024;
constexpr std::size_t kPage = 4096;

bool lockingIsUnlimited() noexcept {
  rlimit limit{};
  return geteuid() == 0 || (getrlimit(RLIMIT_MEMLOCK, &limit) == 0 && limit.rlim_cur == RLIM_INFINITY);
}

}  // namespace

int lockMemory() noexcept {
  mallopt(M_TRIM_THRESHOLD, -1);
  mallopt(M_MMAP_MAX, 0);
  const int scope = lockingIsUnlimited() ? MCL_CURRENT | MCL_FUTURE : MCL_CURRENT;
  return mlockall(scope) == 0 ? 0 : errno;
}

void prefaultStack() noexcept {
  std::array<char, kStackBytes> stack;  // deliberately not initialized: one write a page is enough
  volatile char* const bytes = stack.data();
  for (std::size_t i = 0; i < kStackBytes; i += kPage) bytes[i] = 0;
}

}  // namespace palpate::rt
