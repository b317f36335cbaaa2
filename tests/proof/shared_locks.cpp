// SPDX-License-Identifier: Apache-2.0
// What force-out waits for where an ordinary thread of the process holds one of Cyclone DDS's locks and a thread with a priority
// in between has the processor (priority inversion). With "inherit", mutexes that are made pass the priority on.
//   shared_locks [inherit] [seconds of each case]
#include <dlfcn.h>
#include <pthread.h>
#include <sched.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <string_view>
#include <thread>

#include "palpate/idl/reader.h"
#include "palpate/idl/writer.h"
#include "palpate/rt/clock.h"
#include "palpate/rt/cycle_stats.h"
#include "palpate/testing/test_domain.h"

namespace palpate::proof {
namespace {

std::atomic<bool> inherit{false};

using Init = int(pthread_mutex_t*, const pthread_mutexattr_t*);

void settle(const char* name, int priority) {
  pthread_setname_np(pthread_self(), name);
  cpu_set_t set;
  CPU_ZERO(&set);
  CPU_SET(0, &set);
  sched_setaffinity(0, sizeof set, &set);
  sched_param parameters{};
  parameters.sched_priority = priority;
  if (priority > 0 && pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameters) != 0) {
    std::fprintf(stderr, "shared_locks: SCHED_FIFO is not granted\n");
    std::exit(1);
  }
}

// Reads what this program writes, in a process of its own.
void readElsewhere(std::uint32_t domain) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  const dds::Participant participant(domain);
  const dds::Reader<dds::ToolForce> forces(participant);
  const dds::Reader<dds::ServerStatus> statuses(participant);
  dds::ToolForce force;
  dds::ServerStatus status;
  while (true) {
    (void)forces.take({&force, 1});
    (void)statuses.take({&status, 1});
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
}

struct Case {
  const char* name;
  bool ordinary;  // an ordinary thread writes ServerStatus as fast as it can
  bool same;      // it writes forces with force-out's own writer instead
  bool hog;       // a thread at FIFO 50 runs for 5 ms of each 20
  bool seldom;    // the ordinary thread pauses for 20 ms after each
};

struct Found {
  rt::CycleStats times;
  int late{0};  // writes that took longer than 1 ms
  unsigned long others{0};
};

Found measure(dds::Writer<dds::ToolForce>& forces, dds::Writer<dds::ServerStatus>& statuses, const Case& one,
              double seconds) {
  Found found;
  std::atomic<bool> stop{false};
  std::thread force_out([&] {
    settle("force-out", 75);
    dds::ToolForce force{};
    std::int64_t next_ns = rt::monotonicNow();
    for (int i = 0; i < static_cast<int>(1000 * seconds); ++i) {
      rt::sleepUntil(next_ns += 1'000'000);
      ++force.seq;
      const std::int64_t begin_ns = rt::monotonicNow();
      (void)forces.write(force);
      const std::int64_t took_ns = rt::monotonicNow() - begin_ns;
      found.times.add(took_ns);
      found.late += took_ns > 1'000'000 ? 1 : 0;
    }
    stop = true;
  });
  std::thread ordinary([&] {
    settle("ordinary", 0);
    dds::ServerStatus status{};
    dds::ToolForce force{};
    while (one.ordinary && !stop) {
      (void)(one.same ? forces.write(force) : statuses.write(status));
      ++found.others;
      if (one.seldom) std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
  });
  std::thread hog([&] {
    settle("hog", 50);
    while (one.hog && !stop) {
      for (const std::int64_t end_ns = rt::monotonicNow() + 5'000'000; rt::monotonicNow() < end_ns;) {
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(15));
    }
  });
  force_out.join();
  ordinary.join();
  hog.join();
  return found;
}

int run(double seconds) {
  const std::uint32_t domain = palpate::testing::exclusiveDomain();
  const pid_t reader = fork();
  if (reader == 0) readElsewhere(domain);
  {
    const dds::Participant participant(domain);
    dds::Writer<dds::ToolForce> forces(participant);
    dds::Writer<dds::ServerStatus> statuses(participant);
    if (!forces.waitForReaders(1, std::chrono::seconds(10)) ||
        !statuses.waitForReaders(1, std::chrono::seconds(10)))
      return 1;
    std::printf("mutexes pass priority on: %s; write of a force / us\n%-44s %8s %8s %8s %8s %7s %9s\n",
                inherit ? "yes" : "no", "", "p50", "p99", "p99.9", "max", "> 1 ms", "others");
    constexpr std::array<Case, 6> kCases{{{"alone", false, false, false, false},
                                          {"ordinary thread writes statuses", true, false, false, false},
                                          {"a thread at FIFO 50", false, false, true, false},
                                          {"both", true, false, true, false},
                                          {"both, 50 statuses a second", true, false, true, true},
                                          {"both, on force-out's own writer", true, true, true, false}}};
    for (const Case& one : kCases) {
      const Found found = measure(forces, statuses, one, seconds);
      const auto us = [&](double q) { return 1e-3 * static_cast<double>(found.times.quantile(q)); };
      std::printf("%-44s %8.1f %8.1f %8.1f %8.1f %7d %9lu\n", one.name, us(0.5), us(0.99), us(0.999),
                  1e-3 * static_cast<double>(found.times.max()), found.late, found.others);
      std::fflush(stdout);
    }
  }
  kill(reader, SIGKILL);
  waitpid(reader, nullptr, 0);
  return 0;
}

}  // namespace
}  // namespace palpate::proof

// In the place of libc's, for the libraries too.
extern "C" int pthread_mutex_init(pthread_mutex_t* mutex, const pthread_mutexattr_t* attributes) noexcept {
  static auto* const next = reinterpret_cast<palpate::proof::Init*>(dlsym(RTLD_NEXT, "pthread_mutex_init"));
  if (!palpate::proof::inherit || attributes != nullptr) return next(mutex, attributes);
  pthread_mutexattr_t passes_on;
  pthread_mutexattr_init(&passes_on);
  pthread_mutexattr_setprotocol(&passes_on, PTHREAD_PRIO_INHERIT);
  const int result = next(mutex, &passes_on);
  pthread_mutexattr_destroy(&passes_on);
  return result;
}

int main(int argc, char** argv) {
  double seconds = 10.0;
  for (int i = 1; i < argc; ++i) {
    if (std::string_view(argv[i]) == "inherit")
      palpate::proof::inherit = true;
    else
      seconds = std::atof(argv[i]);
  }
  return palpate::proof::run(seconds);
}
