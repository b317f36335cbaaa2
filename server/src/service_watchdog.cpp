// SPDX-License-Identifier: Apache-2.0
#include "palpate/server/service_watchdog.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>
#include <string>

#include "palpate/rt/clock.h"

namespace palpate::server {
namespace {

constexpr std::int64_t kLongestLook = 100'000'000;  // ns: the period of the slowest tick

}  // namespace

// The manager's patience is what a stall of the machine is forgiven: a look that finds no tick since the one before gives no sign,
// the next one may.
void ServiceWatchdog::run() noexcept {
  const std::int64_t patience_ns = std::chrono::nanoseconds(manager_.patience()).count();
  const std::int64_t look_ns = std::min(kLongestLook, patience_ns / 8);
  std::int64_t fed_ns = rt::monotonicNow();
  while (!ended_.load(std::memory_order_relaxed)) {
    (void)ended_ready_.waitFor(look_ns);
    const std::int64_t now_ns = rt::monotonicNow();
    const bool stopping = stopping_.load(std::memory_order_relaxed);
    const char* const fault = stopping ? nullptr : this->fault(now_ns);
    if (fault == nullptr && now_ns - fed_ns >= patience_ns / 4) {
      manager_.tell(told_ && !stopping ? "WATCHDOG=1\nSTATUS=serving again" : "WATCHDOG=1");
      told_ = told_ && stopping;
      fed_ns = now_ns;
    }
    if (fault != nullptr && !told_ && now_ns - fed_ns >= patience_ns / 2) tellOf(fault);
  }
}

void ServiceWatchdog::end() noexcept {
  ended_.store(true, std::memory_order_relaxed);
  ended_ready_.post();
}

// Null where nothing is wrong.
const char* ServiceWatchdog::fault(std::int64_t now_ns) {
  const std::uint64_t cycles = tick_.cycles();
  const bool ticks = cycles != cycles_;
  cycles_ = cycles;
  const std::uint64_t rounds = rounds_.load(std::memory_order_relaxed);
  const bool sends = rounds != last_rounds_;
  last_rounds_ = rounds;
  const bool takes = receive_.takes(now_ns);
  if (!ticks) return "ticks stand still";
  if (!sends) return "forces are not sent";
  return takes ? nullptr : "what comes in over DDS is not taken";
}

void ServiceWatchdog::tellOf(const char* fault) {
  told_ = true;
  manager_.tell(std::string("STATUS=") + fault);
  spdlog::critical("{}: the service manager gets no sign of life, and will start the server again", fault);
}

}  // namespace palpate::server
