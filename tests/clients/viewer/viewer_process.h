// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace palpate::testing {

/// palpate-viewer as its own process on a free port, with a page of one line. Killed by the destructor if it runs.
class ViewerProcess {
 public:
  explicit ViewerProcess(const std::string& domain, const std::vector<std::string>& more = {});
  ~ViewerProcess();
  ViewerProcess(const ViewerProcess&) = delete;
  ViewerProcess& operator=(const ViewerProcess&) = delete;

  /// 0: it did not start to listen.
  [[nodiscard]] std::uint16_t port() const noexcept { return port_; }
  /// Its first line on standard output.
  [[nodiscard]] const std::string& announcement() const noexcept { return announcement_; }

  [[nodiscard]] bool running();
  /// Sends a signal and waits. @return exit code, 128 + n when signal n ended it, -1 when it still runs after 20 s
  int end(int signal);

 private:
  std::filesystem::path page_;
  pid_t pid_{-1};
  int exit_code_{-1};
  std::uint16_t port_{0};
  std::string announcement_;
};

}  // namespace palpate::testing
