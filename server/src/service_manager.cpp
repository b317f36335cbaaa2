// SPDX-License-Identifier: Apache-2.0
#include "palpate/server/service_manager.h"

#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <cstdlib>

namespace palpate::server {
namespace {

std::string_view fromEnvironment(const char* name) {
  const char* const value = std::getenv(name);
  return value == nullptr ? std::string_view() : value;
}

// 0 where the variable is not a whole number above 0.
std::int64_t numberOf(const char* name) {
  const std::string_view text = fromEnvironment(name);
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size() && value > 0 ? value : 0;
}

// What is shorter cannot be kept; what is longer needs no more.
constexpr std::int64_t kLeastPatience = 10'000, kMostPatience = 86'400'000'000;  // us

}  // namespace

ServiceManager::ServiceManager() {
  const std::string_view path = fromEnvironment("NOTIFY_SOCKET");
  if (path.size() < 2 || path.size() >= sizeof address_.sun_path || (path[0] != '/' && path[0] != '@'))
    return;
  address_.sun_family = AF_UNIX;
  path.copy(address_.sun_path, path.size());
  if (path[0] == '@') address_.sun_path[0] = '\0';  // a name without a file
  size_ = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + path.size());
  socket_ = socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  const std::int64_t watched = numberOf("WATCHDOG_PID");  // 0: any process that reads it
  const std::int64_t patience = numberOf("WATCHDOG_USEC");
  if (socket_ >= 0 && patience > 0 && (watched == 0 || watched == getpid()))
    patience_ = std::chrono::microseconds(std::clamp(patience, kLeastPatience, kMostPatience));
}

ServiceManager::~ServiceManager() {
  if (socket_ >= 0) close(socket_);
}

void ServiceManager::tell(std::string_view lines) const noexcept {
  if (socket_ < 0) return;
  (void)sendto(socket_, lines.data(), lines.size(), MSG_NOSIGNAL | MSG_DONTWAIT,
               static_cast<const sockaddr*>(static_cast<const void*>(&address_)), size_);
}

}  // namespace palpate::server
