// SPDX-License-Identifier: Apache-2.0
// What it costs a thread to read itself (docs/decisions/late_ticks.md): medians of 200 rounds of 100, ns.
#include <sys/mman.h>
#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <ctime>

#include "palpate/rt/clock.h"
#include "palpate/rt/thread_reading.h"

namespace palpate::rt {
namespace {

template <class Call>
void measure(const char* name, Call call) {
  constexpr int kCalls = 100;
  std::array<std::int64_t, 200> rounds{};
  for (std::int64_t& round : rounds) {
    const std::int64_t begin_ns = monotonicNow();
    for (int i = 0; i < kCalls; ++i) call(i);
    round = (monotonicNow() - begin_ns) / kCalls;
  }
  std::nth_element(rounds.begin(), rounds.begin() + 100, rounds.end());
  std::printf("%-24s %6lld\n", name, static_cast<long long>(rounds[100]));
}

// 100 pages, touched and given back.
void measureFaults() {
  constexpr std::size_t kPage = 4096, kPages = 100;
  void* const pages =
      mmap(nullptr, kPages * kPage, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (pages == MAP_FAILED) return;
  madvise(pages, kPages * kPage, MADV_NOHUGEPAGE);
  measure("minor fault", [pages](int i) {
    if (i == 0) madvise(pages, kPages * kPage, MADV_DONTNEED);
    static_cast<volatile char*>(pages)[static_cast<std::size_t>(i) * kPage] = 1;
  });
  munmap(pages, kPages * kPage);
}

int run() {
  timespec time{};
  rusage usage{};
  const RunQueueFile queue;
  measure("CLOCK_MONOTONIC", [&](int) { clock_gettime(CLOCK_MONOTONIC, &time); });
  measure("CLOCK_THREAD_CPUTIME_ID", [&](int) { clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time); });
  measure("getrusage", [&](int) { getrusage(RUSAGE_THREAD, &usage); });
  measure("readThisThread", [](int) { (void)readThisThread(); });
  measure("schedstat", [&](int) { (void)queue.queued_ns(); });
  measureFaults();
  return 0;
}

}  // namespace
}  // namespace palpate::rt

int main() {
  return palpate::rt::run();
}
