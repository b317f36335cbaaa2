// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/socket.h>
#include <sys/un.h>

#include <chrono>
#include <string_view>

namespace palpate::server {

/// The service manager that started this process, systemd for one: told how it goes by the protocol of sd_notify(3), lines in a
/// datagram to the socket that NOTIFY_SOCKET names (docs/decisions/service_watchdog.md). Started by hand there is none, and words
/// go nowhere. Threads: any. Real-time: no.
class ServiceManager {
 public:
  /// Reads NOTIFY_SOCKET, WATCHDOG_USEC and WATCHDOG_PID.
  ServiceManager();
  ~ServiceManager();
  ServiceManager(const ServiceManager&) = delete;
  ServiceManager& operator=(const ServiceManager&) = delete;

  /// After how long without WATCHDOG=1 it ends this process; 0: it does not watch, or
  /// WATCHDOG_USEC is no number. Between 10 ms and a day.
  [[nodiscard]] std::chrono::microseconds patience() const noexcept { return patience_; }

  /// @param[in] lines  e.g. "READY=1\nSTATUS=serving". What cannot be sent is lost.
  void tell(std::string_view lines) const noexcept;

 private:
  int socket_{-1};
  sockaddr_un address_{};
  socklen_t size_{0};
  std::chrono::microseconds patience_{0};
};

}  // namespace palpate::server
