// SPDX-License-Identifier: Apache-2.0
#include "service_manager.h"

#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <sstream>
#include <stdexcept>

namespace palpate::faults {
namespace {

using Clock = std::chrono::steady_clock;

}  // namespace

PlayedManager::PlayedManager(std::chrono::milliseconds patience, int watched_pid, bool abstract)
    : socket_(socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
  const std::string name =
      abstract ? "@palpate-test-" + std::to_string(getpid()) : (folder_ / "notify").string();
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  name.copy(address.sun_path, sizeof address.sun_path - 1);
  if (abstract) address.sun_path[0] = '\0';
  const auto size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + name.size());
  if (bind(socket_, static_cast<const sockaddr*>(static_cast<const void*>(&address)), size) != 0)
    throw std::runtime_error("no socket at " + name);
  setenv("NOTIFY_SOCKET", name.c_str(), 1);
  if (patience.count() > 0)
    setenv("WATCHDOG_USEC", std::to_string(std::chrono::microseconds(patience).count()).c_str(), 1);
  if (watched_pid > 0) setenv("WATCHDOG_PID", std::to_string(watched_pid).c_str(), 1);
}

PlayedManager::~PlayedManager() {
  forget();
  close(socket_);
}

void PlayedManager::forget() {
  for (const char* const variable : {"NOTIFY_SOCKET", "WATCHDOG_USEC", "WATCHDOG_PID"}) unsetenv(variable);
}

// The lines of one datagram; none when the time is over.
std::vector<std::string> PlayedManager::next(Clock::time_point until) {
  pollfd wait{socket_, POLLIN, 0};
  const auto left = std::chrono::ceil<std::chrono::milliseconds>(until - Clock::now()).count();
  if (poll(&wait, 1, static_cast<int>(std::max<std::int64_t>(left, 0))) != 1) return {};
  char text[4096];
  const ssize_t size = recv(socket_, text, sizeof text, 0);
  std::istringstream stream(std::string(text, static_cast<std::size_t>(std::max<ssize_t>(size, 0))));
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

bool PlayedManager::waitFor(const std::string& line, std::chrono::milliseconds longest) {
  const auto until = Clock::now() + longest;
  while (Clock::now() < until)
    for (const std::string& came : next(until))
      if (came == line) return true;
  return false;
}

std::vector<std::string> PlayedManager::linesOf(std::chrono::milliseconds time) {
  const auto until = Clock::now() + time;
  std::vector<std::string> all;
  while (Clock::now() < until)
    for (std::string& came : next(until)) all.push_back(std::move(came));
  return all;
}

}  // namespace palpate::faults
