// SPDX-License-Identifier: Apache-2.0
#include "core/reader/sandbox.h"

#include <linux/futex.h>
#include <malloc.h>
#include <seccomp.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <memory>
#include <stdexcept>
#include <string>

#include "core/data/available_memory.h"

namespace palpate {

namespace {

/// @param failed  0, or minus errno
void require(int failed, const char* what) {
  if (failed == 0) return;
  throw std::runtime_error(std::string("this machine cannot lock a process down, ") + what + ": " +
                           std::strerror(-failed));
}

/// Lowers a limit; what is lower stays as it is. @param soft  where it is told  @param hard  where it ends
void limit(__rlimit_resource resource, rlim_t soft, rlim_t hard) {
  rlimit now{};
  require(::getrlimit(resource, &now) == 0 ? 0 : -errno, "getrlimit");
  const rlim_t most = std::min(hard, now.rlim_max);
  const rlimit lower{std::min({soft, now.rlim_cur, most}), most};
  require(::setrlimit(resource, &lower) == 0 ? 0 : -errno, "setrlimit");
}

void limit(__rlimit_resource resource, rlim_t most) {
  limit(resource, most, most);
}

void setLimits([[maybe_unused]] std::size_t room) {
  constexpr rlim_t kSeconds = 10;
  // The runtimes of sanitizers take all addresses, and open pipes.
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
  limit(RLIMIT_AS, addressSpace() + room);  // first: a file says how many there are
  limit(RLIMIT_NOFILE, 0);
#endif
  limit(RLIMIT_CPU, kSeconds, kSeconds + 1);  // Linux says SIGXCPU at the first only, at the second SIGKILL
  for (const __rlimit_resource none : {RLIMIT_CORE, RLIMIT_FSIZE}) limit(none, 0);
}

}  // namespace

void lockDown(int output, std::size_t room) {
  setLimits(room);
  // Where memory is short malloc() would try another arena, and ask for the number of processors before.
  ::mallopt(M_ARENA_MAX, 1);
  require(::prctl(PR_SET_DUMPABLE, 0, 0, 0, 0) == 0 ? 0 : -errno, "PR_SET_DUMPABLE");
  // Of the first interface: prctl() instead of seccomp(), which a service's own filter (palpate-server.service) may kill for.
  require(::seccomp_api_set(1), "seccomp_api_set");
  const std::unique_ptr<void, void (*)(scmp_filter_ctx)> filter(::seccomp_init(SCMP_ACT_KILL),
                                                                ::seccomp_release);
  require(filter ? 0 : -ENOMEM, "seccomp_init");
  const auto add = [&](std::uint32_t action, int call, auto... where) {
    require(::seccomp_rule_add(filter.get(), action, call, sizeof...(where), where...), "seccomp_rule_add");
  };
  const auto allow = [&](int call, auto... where) { add(SCMP_ACT_ALLOW, call, where...); };
  const auto runs = static_cast<scmp_datum_t>(PROT_EXEC), nameless = static_cast<scmp_datum_t>(MAP_ANONYMOUS);
  allow(SCMP_SYS(mmap), SCMP_A2(SCMP_CMP_MASKED_EQ, runs, 0U),
        SCMP_A3(SCMP_CMP_MASKED_EQ, nameless, nameless));
  for (const int memory : {SCMP_SYS(munmap), SCMP_SYS(mremap), SCMP_SYS(brk)}) allow(memory);
  allow(SCMP_SYS(write), SCMP_A0(SCMP_CMP_EQ, static_cast<scmp_datum_t>(output)));
  // The first exception wakes who may wait for its tables.
  allow(SCMP_SYS(futex), SCMP_A1(SCMP_CMP_EQ, static_cast<scmp_datum_t>(FUTEX_WAKE_PRIVATE)));
  allow(SCMP_SYS(exit_group));
  // HDF5 tries to open a file of the image's name, to see that there is none.
  add(SCMP_ACT_ERRNO(EACCES), SCMP_SYS(openat));
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)  // what their runtimes do beside
  for (const int more :
       {SCMP_SYS(madvise), SCMP_SYS(mprotect), SCMP_SYS(futex), SCMP_SYS(getpid), SCMP_SYS(gettid),
        SCMP_SYS(sched_yield), SCMP_SYS(sigaltstack), SCMP_SYS(rt_sigprocmask), SCMP_SYS(clock_gettime),
        SCMP_SYS(pipe2), SCMP_SYS(write), SCMP_SYS(close)})
    allow(more);
#endif
  require(::seccomp_load(filter.get()), "seccomp_load");
}

}  // namespace palpate
