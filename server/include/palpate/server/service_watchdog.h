// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>

#include "palpate/rt/periodic_thread.h"
#include "palpate/rt/semaphore.h"
#include "palpate/server/receive_watch.h"
#include "palpate/server/service_manager.h"

namespace palpate::server {

/// Gives the service manager its sign of life, a quarter of its patience apart, as long as ticks go on, forces are sent and what comes
/// in over DDS is taken; the manager kills and restarts a server that gives none (docs/decisions/service_watchdog.md). Real-time: no.
class ServiceWatchdog {
 public:
  /// All must outlive it. @param rounds  Channels::force_rounds
  ServiceWatchdog(const ServiceManager& manager, const rt::PeriodicThread& tick,
                  const std::atomic<std::uint64_t>& rounds, std::uint32_t domain)
      : manager_(manager), tick_(tick), rounds_(rounds), receive_(domain) {}

  /// Body of the watchdog thread; returns after end().
  void run() noexcept;

  /// From now on ticks, forces and poses may end: signs of life are given all the same, the manager bounds a stop by another time.
  void stopping() noexcept { stopping_.store(true, std::memory_order_relaxed); }
  void end() noexcept;

 private:
  [[nodiscard]] const char* fault(std::int64_t now_ns);
  void tellOf(const char* fault);

  const ServiceManager& manager_;
  const rt::PeriodicThread& tick_;
  const std::atomic<std::uint64_t>& rounds_;
  ReceiveWatch receive_;
  std::uint64_t cycles_{0}, last_rounds_{0};
  bool told_{false};  // of a fault that is not over
  std::atomic<bool> stopping_{false};
  std::atomic<bool> ended_{false};  // both are flags, relaxed: the semaphore orders
  rt::Semaphore ended_ready_;
};

}  // namespace palpate::server
