// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <string>
#include <vector>

#include "palpate/testing/files.h"

namespace palpate::faults {

/// In the place of systemd: the socket that a service tells how it goes, and the environment that names it.
class PlayedManager {
 public:
  /// Sets NOTIFY_SOCKET, WATCHDOG_USEC and WATCHDOG_PID for what is started from now on.
  /// @param[in] patience     0: watches nothing
  /// @param[in] watched_pid  0: whichever process reads it
  /// @param[in] abstract     the socket has a name and no file
  explicit PlayedManager(std::chrono::milliseconds patience, int watched_pid = 0, bool abstract = false);
  ~PlayedManager();
  PlayedManager(const PlayedManager&) = delete;
  PlayedManager& operator=(const PlayedManager&) = delete;

  /// What is started from now on knows of no manager.
  static void forget();

  /// @return whether a line came within `longest`; lines before it are dropped
  [[nodiscard]] bool waitFor(const std::string& line, std::chrono::milliseconds longest);

  /// The lines that come within `time`.
  [[nodiscard]] std::vector<std::string> linesOf(std::chrono::milliseconds time);

 private:
  [[nodiscard]] std::vector<std::string> next(std::chrono::steady_clock::time_point until);

  palpate::testing::TemporaryFolder folder_;
  int socket_;
};

}  // namespace palpate::faults
