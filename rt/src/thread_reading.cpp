// SPDX-License-Identifier: Apache-2.0
#include "palpate/rt/thread_reading.h"

#include <fcntl.h>
#include <sched.h>
#include <sys/resource.h>
#include <unistd.h>

#include <array>
#include <charconv>
#include <ctime>
#include <string>

namespace palpate::rt {
namespace {

// Trusted: clocks are read without a system call, but for the thread's own, which asks the scheduler; getrusage() copies
// counters of the calling thread; sched_getcpu() reads a register.
PALPATE_TRUSTED_BEGIN
std::int64_t timeOn(clockid_t clock) noexcept PALPATE_NONBLOCKING {
  timespec now{};
  clock_gettime(clock, &now);
  return static_cast<std::int64_t>(now.tv_sec) * 1'000'000'000 + now.tv_nsec;
}

rusage usageOfThisThread() noexcept PALPATE_NONBLOCKING {
  rusage usage{};
  getrusage(RUSAGE_THREAD, &usage);
  return usage;
}

int cpuOfThisThread() noexcept PALPATE_NONBLOCKING {
  return sched_getcpu();
}
PALPATE_TRUSTED_END

std::size_t readAgain(int file, std::array<char, 96>& text) noexcept {
  const ssize_t length = file < 0 ? 0 : pread(file, text.data(), text.size(), 0);
  return length < 0 ? 0 : static_cast<std::size_t>(length);
}

const char* numberAt(const char* begin, const char* end, std::int64_t& value) noexcept {
  const auto [next, error] = std::from_chars(begin, end, value);
  return error == std::errc{} ? next : nullptr;
}

int openForReading(const char* path) noexcept {
  return open(path, O_RDONLY | O_CLOEXEC);
}

// The three at one time: again, if something came in between.
void readClocks(ThreadReading& reading) noexcept PALPATE_NONBLOCKING {
  constexpr std::int64_t kClose = 2'000;  // ns
  for (int tries = 0; tries < 4; ++tries) {
    const std::int64_t first_ns = timeOn(CLOCK_MONOTONIC_RAW);
    reading.at_ns = timeOn(CLOCK_MONOTONIC);
    reading.boot_ns = timeOn(CLOCK_BOOTTIME);
    reading.raw_ns = timeOn(CLOCK_MONOTONIC_RAW);
    if (reading.raw_ns - first_ns < kClose) return;
  }
}

}  // namespace

ThreadReading readThisThread() noexcept PALPATE_NONBLOCKING {
  ThreadReading reading;
  readClocks(reading);
  reading.cpu_ns = timeOn(CLOCK_THREAD_CPUTIME_ID);
  const rusage usage = usageOfThisThread();
  reading.minor_faults = usage.ru_minflt;
  reading.major_faults = usage.ru_majflt;
  reading.waits = usage.ru_nvcsw;
  reading.cpu = cpuOfThisThread();
  return reading;
}

RunQueueFile::RunQueueFile() noexcept : file_(openForReading("/proc/thread-self/schedstat")) {}

RunQueueFile::RunQueueFile(int thread_id)
    : file_(openForReading(("/proc/self/task/" + std::to_string(thread_id) + "/schedstat").c_str())) {}

RunQueueFile::~RunQueueFile() {
  if (file_ >= 0) close(file_);
}

// "ran waited slices", ns, ns and a count (Documentation/scheduler/sched-stats).
std::int64_t RunQueueFile::queued_ns() const noexcept {
  std::array<char, 96> text;
  const char* const end = text.data() + readAgain(file_, text);
  std::int64_t ran = 0;
  std::int64_t queued = 0;
  const char* const blank = numberAt(text.data(), end, ran);
  if (blank == nullptr || blank == end || numberAt(blank + 1, end, queued) == nullptr) return -1;
  return queued;
}

}  // namespace palpate::rt
