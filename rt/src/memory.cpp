// SPDX-License-Identifier: Apache-2.0
#include "palpate/rt/memory.h"

#include <linux/capability.h>
#include <malloc.h>
#include <pthread.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstddef>

namespace palpate::rt {
namespace {

constexpr std::size_t kPrefaulted = std::size_t{256} * 1024;  // of a stack
constexpr std::size_t kThreadStack = std::size_t{1024} * 1024;
constexpr std::size_t kPage = 4096;
constexpr int kMappedApart = 2 * 1024 * 1024;  // bytes; DDS takes less for most messages

// The effective capability decides, not the user: root in a container may lack it, a service may have it.
bool mayLockWithoutLimit() noexcept {
  __user_cap_header_struct header{_LINUX_CAPABILITY_VERSION_3, 0};
  __user_cap_data_struct data[_LINUX_CAPABILITY_U32S_3]{};
  if (syscall(SYS_capget, &header, data) != 0) return false;
  return (data[CAP_TO_INDEX(CAP_IPC_LOCK)].effective & CAP_TO_MASK(CAP_IPC_LOCK)) != 0;
}

bool lockingIsUnlimited() noexcept {
  rlimit limit{};
  return mayLockWithoutLimit() || (getrlimit(RLIMIT_MEMLOCK, &limit) == 0 && limit.rlim_cur == RLIM_INFINITY);
}

}  // namespace

MemoryLock lockMemory() noexcept {
  mallopt(M_TRIM_THRESHOLD, -1);
  mallopt(M_MMAP_THRESHOLD, kMappedApart);
  const bool unlimited = lockingIsUnlimited();
  if (mlockall(unlimited ? MCL_CURRENT | MCL_FUTURE : MCL_CURRENT) != 0) return {errno, false, false};
  return {0, true, unlimited};
}

void shortenThreadStacks() noexcept {
  pthread_attr_t attributes;
  if (pthread_getattr_default_np(&attributes) != 0) return;
  std::size_t usual = 0;
  pthread_attr_getstacksize(&attributes, &usual);
  if (usual > kThreadStack && pthread_attr_setstacksize(&attributes, kThreadStack) == 0)
    pthread_setattr_default_np(&attributes);
  pthread_attr_destroy(&attributes);
}

void prefaultStack() noexcept {
  std::array<char, kPrefaulted> stack;  // not initialized: one write per page is enough
  volatile char* const bytes = stack.data();
  for (std::size_t i = 0; i < kPrefaulted; i += kPage) bytes[i] = 0;
}

}  // namespace palpate::rt
