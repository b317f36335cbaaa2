// SPDX-License-Identifier: Apache-2.0
// A device driver as docs and driver_template show it, in a process of its own, so that it can be stopped, and put behind a network:
// presses the top of the tests' round organ and holds it. What it renders goes into a Trace.
//   fault_device DOMAIN TRACE [CPUS]
#include <fcntl.h>
#include <sched.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>

#include "palpate/haptic/haptic_tool.h"
#include "palpate/rt/clock.h"
#include "palpate/rt/memory.h"
#include "palpate/rt/scheduling.h"
#include "trace.h"

namespace palpate::faults {
namespace {

constexpr std::int64_t kPeriod = 1'000'000;  // ns
constexpr double kOrganRadius = 0.05;        // m
constexpr double kAbove = 0.003;             // m, where it begins
constexpr double kApproach = 300.0;          // periods
constexpr int kPriority = 60;

Trace& mapped(const char* path) {
  const int file = open(path, O_RDWR | O_CLOEXEC);
  void* const memory = mmap(nullptr, sizeof(Trace), PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
  if (memory == MAP_FAILED) std::exit(1);
  close(file);
  return *static_cast<Trace*>(memory);
}

// Before there are other threads, which inherit it.
void useCpu(int cpu) {
  cpu_set_t set;
  CPU_ZERO(&set);
  CPU_SET(cpu, &set);
  if (sched_setaffinity(0, sizeof set, &set) != 0) std::exit(1);
}

[[noreturn]] void press(haptic::HapticTool& tool, Trace& trace) {
  std::int64_t due_ns = rt::monotonicNow();
  std::uint64_t next = 0;
  double approached = 0.0;  // periods since a server was there
  for (;;) {
    rt::sleepUntil(due_ns);
    due_ns = std::max(due_ns + kPeriod, rt::monotonicNow());
    const double share = std::min(approached / kApproach, 1.0);
    const haptic::Vec3 p{0.0, 0.0, kOrganRadius + kTipRadius + kAbove - share * (kAbove + kDepth)};
    tool.send(p);
    const haptic::Force force = tool.forceAt(p);
    if (force.session != 0) approached += 1.0;
    const auto& f = force.force;
    trace.samples[next % trace.samples.size()] = {
        rt::monotonicNow(), std::hypot(f[0], f[1], f[2]), f[2], force.gain, force.age_s, force.pose_seq,
        force.session};
    trace.count.store(++next, std::memory_order_release);  // SYNC TRACE
  }
}

}  // namespace
}  // namespace palpate::faults

int main(int argc, char** argv) {
  using namespace palpate;
  if (argc < 3) return 2;
  if (argc > 3) faults::useCpu(std::atoi(argv[3]));
  (void)rt::lockMemory();
  try {
    haptic::HapticTool tool({.domain = static_cast<std::uint32_t>(std::atoi(argv[1])),
                             .force_limit = 10.0,
                             .receive_priority = 65});
    (void)rt::raiseThisThread(faults::kPriority);
    faults::press(tool, faults::mapped(argv[2]));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
