// SPDX-License-Identifier: Apache-2.0
#include "palpate/client/pacer.h"

#include <algorithm>
#include <cerrno>
#include <ctime>

namespace palpate::client {
namespace {

constexpr std::int64_t kNsPerSecond = 1'000'000'000;

}  // namespace

std::int64_t nowNs() noexcept {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return static_cast<std::int64_t>(now.tv_sec) * kNsPerSecond + now.tv_nsec;
}

Pacer::Pacer(std::int64_t period_ns) noexcept
    : period_ns_(std::max<std::int64_t>(period_ns, 1)), next_ns_(nowNs() + period_ns_) {}

std::int64_t Pacer::wait() noexcept {
  const timespec until{static_cast<time_t>(next_ns_ / kNsPerSecond),
                       static_cast<long>(next_ns_ % kNsPerSecond)};
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr) == EINTR) {
  }
  const std::int64_t late_ns = std::max<std::int64_t>(nowNs() - next_ns_, 0);
  const std::int64_t periods_missed = late_ns / period_ns_;
  missed_ += static_cast<std::uint64_t>(periods_missed);
  next_ns_ += (periods_missed + 1) * period_ns_;
  return late_ns;
}

}  // namespace palpate::client
