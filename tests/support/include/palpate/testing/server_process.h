// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "palpate/testing/child_process.h"

namespace palpate::testing {

/// palpate-server as its own process. The destructor kills it if it still runs. A failed test does not run again where a
/// signal that it did not send has ended the server (timed_tests.h).
class ServerProcess {
 public:
  /// @param[in] log_fd  where its standard error goes, borrowed; -1: into log()
  explicit ServerProcess(const std::vector<std::string>& arguments, int log_fd = -1);

  ~ServerProcess();
  ServerProcess(const ServerProcess&) = delete;
  ServerProcess& operator=(const ServerProcess&) = delete;

  void signal(int number) {
    sent_ = number;
    process_.signal(number);
  }
  /// @return exit code; 128 + n when signal n ended it; -1 when it still runs after the timeout
  [[nodiscard]] int waitForExit(std::chrono::seconds timeout = std::chrono::seconds(30)) {
    return process_.waitForExit(timeout);
  }
  /// What it wrote to standard error so far.
  [[nodiscard]] std::string log() const { return log_.text(); }
  [[nodiscard]] bool running() { return process_.running(); }
  /// -1 once it has ended.
  [[nodiscard]] pid_t pid() const noexcept { return process_.pid(); }

 private:
  CaughtOutput log_;
  ChildProcess process_;
  int sent_{0};  // the last signal
};

}  // namespace palpate::testing
