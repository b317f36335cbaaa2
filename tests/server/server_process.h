// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <chrono>
#include <string>
#include <vector>

namespace palpate::server::testing {

/// palpate-server as its own process, its standard error in a file. Killed by the destructor if it still
/// runs.
class ServerProcess {
 public:
  /// @param[in] log_fd  where its standard error goes instead, borrowed; -1: into the file
  explicit ServerProcess(const std::vector<std::string>& arguments, int log_fd = -1);
  ~ServerProcess();
  ServerProcess(const ServerProcess&) = delete;
  ServerProcess& operator=(const ServerProcess&) = delete;

  void signal(int number) const;

  /// @return exit code; 128 + n when signal n ended it; -1 when it still runs after the timeout
  [[nodiscard]] int waitForExit(std::chrono::seconds timeout = std::chrono::seconds(30));

  /// What it wrote to standard error so far.
  [[nodiscard]] std::string log() const;

  [[nodiscard]] bool running();

  /// -1 once it has ended.
  [[nodiscard]] pid_t pid() const { return pid_; }

 private:
  pid_t pid_{-1};
  int exit_code_{-1};
  std::string log_path_;
};

}  // namespace palpate::server::testing
